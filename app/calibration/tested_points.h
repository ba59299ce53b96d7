#pragma once

#include "app/input/input.h"
#include "app/screen/progress.h"
#include "calibration/response_model.h"

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

namespace feldspar::calibration
{
/// Why a test of the programme cannot begin on a packing of this rock; empty if all can. A Brazilian disc, for one, may have
/// no grain where it is loaded. A packing that was found good stays so in folder/calibration.
template <int dim>
std::string objection_to_packing(const Input& rock, std::uint64_t seed, const std::filesystem::path& folder);

/// Fills in the values of each point: runs the programme of the input on it, as many at a time as there are threads, by the same
/// code as `feldspar lab`. Results are kept in folder/calibration, a file each, and are not computed again; a test that was
/// interrupted is resumed from its checkpoint. Throws Interrupted.
template <int dim>
std::vector<TestedPoint> test_points(const Input& input, const std::vector<Response>& responses,
                                     std::vector<TestedPoint> points, const std::filesystem::path& folder,
                                     Progress& progress);
} // namespace feldspar::calibration

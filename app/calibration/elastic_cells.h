#pragma once

#include "app/input/input.h"
#include "app/screen/progress.h"
#include "calibration/elastic_table.h"
#include "calibration/parameters.h"
#include "dem/specimen/specimen.h"

#include <filesystem>
#include <optional>

namespace feldspar::calibration
{
/// Elastic constants of the input's rock from intact periodic cells of some 900 grains: the mean of three packings for
/// each stiffness ratio between the bounds, and each gap between them (or the one given). Without bounds, the input's
/// own ratio is used. Results are kept in folder/calibration, a file for each ratio and gap, and are not computed
/// again.
template <int dim>
ElasticTable elastic_constants(const Input& input, const std::optional<Bounds>& stiffness_ratio,
                               const std::optional<Bounds>& gap, double gap_of_specimens,
                               const std::filesystem::path& folder, Progress& progress);

/// A specimen of the input.
template <int dim>
Specimen<dim> packing_of(const Input& input, std::uint64_t seed);
} // namespace feldspar::calibration

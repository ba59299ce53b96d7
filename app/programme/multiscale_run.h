#pragma once

#include "app/input/input.h"
#include "app/screen/progress.h"
#include "runs/samples.h"

#include <filesystem>
#include <vector>

/// The parts of a multiscale run: its RVEs and its programme.
namespace feldspar
{
/// Makes the RVEs of every seed, each on one rank, or reads those that lie in the folder of the run. Collective, as
/// everything here. Throws InputError, and Interrupted.
std::vector<Rock> make_rocks(const Input& input, const std::filesystem::path& input_file,
                             const std::filesystem::path& folder, Progress& progress);

SampleSettings sample_settings(const Input& input);

/// Rocks and settings must outlive it.
std::vector<PlannedSample> plan(const Input& input, const std::vector<Rock>& rocks, const SampleSettings& settings);
} // namespace feldspar

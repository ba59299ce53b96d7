#pragma once

#include "results/runs/series.h"

#include <filesystem>

namespace feldspar
{
/// Reads a curve measured in a laboratory: CSV with the columns axial_strain, lateral_strain, axial_stress and
/// confining_pressure in any order, each with its unit in square brackets: `axial_stress [MPa]` (docs/report.md).
/// Compression is positive, so that a specimen that widens has negative lateral strains. It is evaluated as a test of
/// the model is; what needs grains has none. Strains are counted from where the load begins; the problems of the series say
/// so where that changes them. Throws InputError, one line with file and line.
Series read_laboratory_curve(const std::filesystem::path& file);
} // namespace feldspar

#pragma once

#include "results/runs/series.h"

#include <filesystem>
#include <optional>
#include <string_view>
#include <vector>

namespace feldspar
{
/// A cylinder that a laboratory has tested [m].
struct CylinderSize
{
  double diameter;
  double height;

  double section() const; ///< [m^2]
};

/// Reads diameter and height, as in `50, 100 mm`. Throws InputError.
CylinderSize parse_cylinder_size(std::string_view text);

/// Reads curves measured in a laboratory, each a test of one series: tables (base/table/csv.h) with axial strain and axial stress,
/// and lateral strain and confining pressure where they were measured, each with its unit: `axial_stress [MPa]`
/// (docs/laboratory-data.md). Forces and displacements need the size of the specimen. Compression is positive, so that a
/// specimen that widens has negative lateral strains. Curves are evaluated as tests of the model are; what a curve lacks has
/// its reason. Strains are counted from where the load begins; the problems of the series say what was changed or left out.
/// Throws InputError, one line with file and line.
Series read_laboratory_curves(const std::vector<std::filesystem::path>& files,
                              const std::optional<CylinderSize>& size = {});
} // namespace feldspar

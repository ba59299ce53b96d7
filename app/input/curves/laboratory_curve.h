#pragma once

#include "laboratory/kinds.h"
#include "results/emission.h"
#include "results/runs/series.h"

#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace feldspar
{
/// A cylinder or a disc that a laboratory has tested [m].
struct CylinderSize
{
  double diameter;
  double height; ///< of a disc its thickness
};

/// Reads diameter and height, as in `50, 100 mm`. Throws InputError.
CylinderSize parse_cylinder_size(std::string_view text);

/// A file with the curve of one test, and what it does not say itself.
struct MeasuredCurve
{
  std::filesystem::path file;
  std::optional<CylinderSize> size = {};
  std::optional<TestKind> kind = {}; ///< none: compression, unless the names of the columns say otherwise
};

/// The curves with sizes and names of tests, each given not at all, once for all curves, or once for each of them. Throws
/// InputError.
std::vector<MeasuredCurve> measured_curves(const std::vector<std::filesystem::path>& files,
                                           const std::vector<std::string>& sizes,
                                           const std::vector<std::string>& tests);

/// Reads curves measured in a laboratory, each a test of one series: tables (base/table/csv.h) with axial strain and axial
/// stress, and lateral strain and confining pressure where they were measured, each with its unit: `axial_stress [MPa]`
/// (docs/laboratory-data.md). Forces and displacements need the size of the specimen. In compression compression is positive, so
/// that a specimen that widens has negative lateral strains; in direct tension and on split discs signs are those of the test,
/// whichever way the file has them. Curves are evaluated as tests of the model are; what a curve lacks has its reason. Strains
/// are counted from where the load begins; the problems of the series say what was changed or left out. Throws InputError, one
/// line with file and line.
Series read_laboratory_curves(const std::vector<MeasuredCurve>& curves);

/// Reads the acoustic emission that a laboratory has recorded: a table with a row for each event or hit in the order of time, with
/// its magnitude, amplitude or energy, and perhaps time and stress, each with its unit: `amplitude [dB]`. Throws InputError, one
/// line with file and line.
EmissionCatalogue read_emission_catalogue(const std::filesystem::path& file);
} // namespace feldspar

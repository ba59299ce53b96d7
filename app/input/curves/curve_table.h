#pragma once

#include "app/input/curves/laboratory_curve.h"
#include "base/input_error.h"
#include "base/table/csv.h"
#include "laboratory/curve.h"
#include "laboratory/kinds.h"

#include <cstddef>
#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace feldspar
{
/// Quantities that a curve may have; compression positive, a specimen that widens has negative lateral strains.
enum class Measured
{
  axial_strain,
  axial_displacement,
  axial_stress,
  deviator,
  axial_force,
  lateral_strain,
  volumetric_strain,
  confining_pressure
};

/// The table of a curve that a laboratory has measured: its columns by their names, its rows in SI.
class CurveTable
{
public:
  explicit CurveTable(const std::filesystem::path& file);

  /// Columns whose names are those of no quantity.
  std::vector<std::string> unread() const;

  /// The kind of test that the name of its stress or force says, other than compression.
  std::optional<TestKind> kind() const;

  /// Returns whether forces or displacements stand for stresses or strains.
  bool needs_size() const
  {
    return !has(Measured::axial_strain) || (!has(Measured::axial_stress) && !has(Measured::deviator));
  }

  /// Reads the rows; stresses and strains tension positive, a lateral strain that is not there is NaN.
  std::vector<CurveSample> rows(const std::optional<CylinderSize>& size, bool is_disc);

private:
  /// The column of a quantity in the file, and its unit in SI.
  struct Column
  {
    std::size_t place;
    double unit;
  };

  bool has(const Measured quantity) const { return columns.contains(quantity); }
  double value(Measured quantity) const; ///< in the row
  double unit_of(std::size_t column, std::string_view unit, Measured quantity) const;
  InputError refusal(const std::string& what) const;

  std::string file;
  CsvReader table;
  std::map<Measured, Column> columns;
};
} // namespace feldspar

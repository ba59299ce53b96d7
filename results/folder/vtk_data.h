#pragma once

#include <array>
#include <cstdint>
#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

namespace feldspar
{
/// A file of points and what lies on them, as VTK reads it by default: XML with its numbers behind it, in single
/// precision. Format: VTK File Formats, "XML File Formats", appended data in raw encoding.
class VtkData
{
public:
  using Components = std::vector<std::array<double, 3>>;

  enum class Cells
  {
    points,    ///< each point by itself
    lines,     ///< each two points
    squares,   ///< each four, around
    hexahedra, ///< each eight, as VTK has them: four around below, four around above
  };

  VtkData(const Components& points, Cells cells);

  // A value for each cell; points have their own. Names end in the SI unit, where there is one.
  void scalar(const std::string& name, const std::vector<double>& values);
  void count(const std::string& name, const std::vector<std::uint32_t>& values);
  void vector(const std::string& name, const Components& values);
  /// Symmetric: xx, xy, xz, yy, yz, zz; nine components in the file.
  void tensor(const std::string& name, const std::vector<std::array<double, 6>>& values);

  /// A value for each point of lines, squares or hexahedra.
  void vector_of_points(const std::string& name, const Components& values);

  /// A value of the whole.
  void of_all(const std::string& name, double value);

  /// Ending of its files: vtu for hexahedra, otherwise vtp.
  std::string ending() const;

  /// Throws OutputError.
  void write(const std::filesystem::path& file) const;

private:
  std::string array(const std::string& name, std::string_view type, std::size_t n_components, const void* data,
                    std::size_t n_bytes);
  std::string reals(const std::string& name, std::size_t n_components, const std::vector<float>& values);

  std::size_t n_points;
  std::size_t n_cells;
  Cells kind;
  std::string geometry;
  std::string connectivity;
  std::string of_points;
  std::string of_cells;
  std::string of_whole;
  std::string appended;
};

/// One of the files of a time series.
struct VtkTime
{
  double time;
  std::string file; ///< from the folder of the series
};

/// The folder for the files of a series, without those of a test that was interrupted and may have left more.
void make_vtk_folder(const std::filesystem::path& folder);

/// The files of a series with their times (.pvd). Throws OutputError.
void write_vtk_series(const std::vector<VtkTime>& times, const std::filesystem::path& file);

/// FOLDER/NAME_paraview.py, for File, Load State, or `paraview --script`: a script of ParaView's around `show`, which shows files
/// of `folder` in `view`. Throws OutputError.
void write_paraview_script(const std::string& name, const std::string& show, const std::filesystem::path& folder);
} // namespace feldspar

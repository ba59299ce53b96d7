#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <map>
#include <string>
#include <vector>

namespace feldspar
{
/// The fields at one time that a test on finite elements left for ParaView (fem/output.h). No nodes: there are none.
struct SampleFields
{
  unsigned int dimension = 0;                              ///< of the mesh
  std::size_t n_rows = 0;                                  ///< of the curve when they were written
  std::vector<std::array<double, 3>> nodes;                ///< at rest [m]; those of each cell are its own
  std::vector<std::array<double, 3>> displacement;         ///< of each node [m]
  std::vector<std::vector<std::uint32_t>> cells;           ///< their nodes: around, or in space as VTK has them
  std::map<std::string, std::vector<double>> of_each_cell; ///< by its name, with its unit

  bool has(const std::string& field) const { return of_each_cell.contains(field); }
  /// A cylinder by half of its section: x is r, y is z.
  bool is_axisymmetric() const { return has("stress_rr_Pa"); }
};

/// Reads FOLDER/NAME.xdmf and what it names of the last time. Throws InputError, one line, where a file is missing or cannot be
/// read.
SampleFields read_sample_fields(const std::filesystem::path& folder, const std::string& name);

/// Reads the same of every time, from the first on, one at a time.
void for_each_time(const std::filesystem::path& folder, const std::string& name,
                   const std::function<void(const SampleFields&)>& look);
} // namespace feldspar

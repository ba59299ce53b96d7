#pragma once

#include <array>
#include <cstdint>
#include <filesystem>
#include <map>
#include <string>
#include <vector>

namespace feldspar::fem
{
/// A mesh of quadrilaterals (2) or hexahedra (3) as Gmsh's library reads it, nodes and elements in the order of their
/// numbers in the file. Nodes of a cell or side are places in `nodes`, in Gmsh's order.
struct GmshMesh
{
  struct Element
  {
    std::array<std::uint32_t, 8> nodes; ///< the first 2 of a line, the first 4 of a quadrilateral
    std::uint32_t group;                ///< physical group; 0 without one, or of a cell several_groups
  };
  static constexpr std::uint32_t several_groups = std::uint32_t(-2);

  std::vector<std::array<double, 3>> nodes;
  std::vector<Element> cells;
  std::vector<Element> sides;
  std::map<std::string, std::uint32_t> groups; ///< of sides; one without a name has its number as name
  std::map<std::string, std::uint32_t> groups_of_cells;
};

/// Reads a Gmsh file (.msh) in a child process, as the library crashes on some damaged files, and checks what deal.II takes
/// on trust: kinds of elements, finite coordinates, at most two cells at a side, each listed side one of a cell and in one
/// physical group. Listed sides between two cells are left out. The library sees a file of this kind alone: it would run a
/// Gmsh script. Throws InputError without the name of the file.
GmshMesh read_gmsh_mesh(const std::filesystem::path& file, int dimension);
} // namespace feldspar::fem

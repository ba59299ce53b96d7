#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string_view>

namespace feldspar::fem
{
/// Reads the text of a Gmsh file (.msh, format 2 or 4) for no other reason than to see whether deal.II's reader, which
/// trusts it, may be given it as a mesh of quadrilaterals (2) or hexahedra (3): counts against the length of the text,
/// nodes that are there once and finite, elements of known kinds between them, sides of cells of at most two cells.
/// Throws InputError, which names the line of what is wrong.
void check_gmsh(std::string_view text, int dimension);

/// Nodes of an element of one of Gmsh's types; none for a type that check_gmsh() takes in neither dimension.
std::optional<std::size_t> n_nodes_of_gmsh_type(std::int64_t type);
} // namespace feldspar::fem

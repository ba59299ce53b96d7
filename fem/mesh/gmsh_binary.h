#pragma once

#include <string>
#include <string_view>

namespace feldspar::fem
{
/// Whether a Gmsh file (.msh) says of itself that it is binary.
bool is_binary_gmsh(std::string_view content);

/// The text of a binary Gmsh file (format 2 or 4.1) up to the end of its elements, number by number and to the last bit,
/// for check_gmsh() and deal.II's reader of text. It is our own since the library of Gmsh, through which deal.II reads
/// binary files, takes their counts on trust. Nothing is read or set aside beyond the bytes that are there. Throws
/// InputError, which names the byte, where the file ends early or has anything else between its sections; whether the
/// numbers make a mesh is for check_gmsh().
std::string text_of_binary_gmsh(std::string_view content);
} // namespace feldspar::fem

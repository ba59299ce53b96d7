#pragma once

#include "dem/flaws/shapes.h"

#include <filesystem>
#include <vector>

/// Joint maps: the traces of joints on a wall or section of the rock, as closed flaws.
namespace feldspar
{
/// The header of a joint map in CSV: a trace a line, y along the axis of the tests [m].
inline constexpr std::string_view header_of_traces = "from_x_m,from_y_m,to_x_m,to_y_m";

/// The traces of a drawing (.dxf; its lines and polylines, in the unit that the drawing names), or else of a
/// CSV. Throws InputError with the name of the file.
std::vector<Shape> read_traces(const std::filesystem::path& file);
} // namespace feldspar

#pragma once

#include "dem/flaws/shapes.h"

#include <cstddef>
#include <filesystem>
#include <string>
#include <vector>

/// Joint maps: the traces of joints on a wall or section of the rock, as closed flaws.
namespace feldspar
{
/// The header of a joint map in CSV: a trace a line, y along the axis of the tests [m]. It may have a column `layer` too.
inline constexpr std::string_view header_of_traces = "from_x_m,from_y_m,to_x_m,to_y_m";

/// The most corners of a line or an outline. The time grows with the number of corners times that of the joints of a
/// specimen; of an outline also with the square of the number of corners.
inline constexpr std::size_t most_corners = 10000;

struct Traces
{
  std::vector<Shape> shapes;
  std::string left_out; ///< a sentence on entities of a drawing that are not visible and not read; empty: none
};

/// The traces of a drawing (.dxf; the lines and polylines of its model space that are to be seen, in the unit that the
/// drawing names), or else of a CSV. Throws InputError with the name of the file.
Traces read_traces(const std::filesystem::path& file);

/// The same of a drawing. Whatever else it shows is refused, but for text, dimensions and pictures.
Traces read_drawing(const std::filesystem::path& file);

/// Throws InputError where there are more traces than a specimen takes.
void check_number_of_traces(std::size_t n, const std::filesystem::path& file);
} // namespace feldspar

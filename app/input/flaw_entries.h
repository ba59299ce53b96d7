#pragma once

#include "app/input/input.h"
#include "base/entries.h"

#include <string_view>
#include <vector>

/// Shapes as the user writes them: `hole centre 25, 50 mm radius 5 mm | slot from 25, 0 mm to 25, 12 mm width 1 mm`.
namespace feldspar
{
/// The entries of section Flaws.
std::vector<Entry<Input>> flaw_entries();

/// The entries of the same section on the place and the layers of a joint map.
std::vector<Entry<MapParameters>> map_entries();

/// Shapes between upright bars. Throws InputError, which names the shape and its word.
std::vector<Shape> parse_shapes(std::string_view text);
} // namespace feldspar

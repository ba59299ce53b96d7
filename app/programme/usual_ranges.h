#pragma once

#include "app/input/input.h"

#include <string>
#include <vector>

namespace feldspar
{
/// A sentence for each value that is allowed but far from any rock's or laboratory's: most likely its unit is not meant.
std::vector<std::string> unusual_values(const std::vector<Variant>& variants);
} // namespace feldspar

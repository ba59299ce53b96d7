#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace feldspar
{
/// `; did you mean "NAME"?` with the name that takes the fewest letters to change; empty if none is near. Says where only
/// capital letters differ.
std::string nearest_name(std::string_view found, const std::vector<std::string_view>& names);

/// The same; if none is near, `; there are` all.
std::string suggestion(std::string_view found, const std::vector<std::string_view>& names);
} // namespace feldspar

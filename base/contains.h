#pragma once

#include <algorithm>
#include <functional>

namespace feldspar
{
/// Returns whether a value is among the elements of a range, or among their members or values by `of`, as
/// std::ranges::contains() of C++23 does.
template <typename Range, typename T, typename Of = std::identity>
constexpr bool contains(const Range& range, const T& value, const Of& of = {})
{
  return std::ranges::find(range, value, of) != std::ranges::end(range);
}
} // namespace feldspar

#pragma once

#include <functional>
#include <vector>

namespace feldspar
{
/// The values of a function, or of a member, for the elements of a range.
template <typename Value, typename Range, typename Of>
std::vector<Value> mapped(const Range& range, const Of& of)
{
  std::vector<Value> values;
  for (const auto& one : range)
    values.emplace_back(std::invoke(of, one));
  return values;
}
} // namespace feldspar

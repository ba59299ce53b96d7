#pragma once

#include <iterator>
#include <utility>
#include <vector>

namespace feldspar
{
/// Moves the elements of `more` behind those of `all`.
template <typename T>
void append(std::vector<T>& all, std::vector<T> more)
{
  std::move(more.begin(), more.end(), std::back_inserter(all));
}
} // namespace feldspar

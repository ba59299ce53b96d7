#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <numeric>
#include <vector>

namespace feldspar
{
/// Sets of the numbers 0 … n - 1, each alone at first, which grow together two at a time. The root of a set is its smallest
/// member, whatever the order of merging (Galler and Fischer 1964, with halved paths). boost::disjoint_sets has the root
/// that its ranks give; here fragments are numbered by it, and must have the same numbers for any order of the joints.
class DisjointSets
{
public:
  explicit DisjointSets(const std::size_t n)
    : parent(n)
  {
    std::iota(parent.begin(), parent.end(), 0u);
  }

  std::uint32_t root(std::uint32_t i)
  {
    while (parent[i] != i)
      i = parent[i] = parent[parent[i]];
    return i;
  }

  void merge(const std::uint32_t one, const std::uint32_t two)
  {
    const auto [low, high] = std::minmax({root(one), root(two)});
    parent[high] = low;
  }

  /// Members of the set of each root; 0 for who is none. [n]
  std::vector<std::uint32_t> sizes()
  {
    std::vector<std::uint32_t> n_members(parent.size(), 0);
    for (std::uint32_t i = 0; i < parent.size(); ++i)
      ++n_members[root(i)];
    return n_members;
  }

  /// The root of the largest set, of equal ones the first.
  std::uint32_t largest()
  {
    const auto n_members = sizes();
    return std::uint32_t(std::ranges::max_element(n_members) - n_members.begin());
  }

private:
  std::vector<std::uint32_t> parent;
};
} // namespace feldspar

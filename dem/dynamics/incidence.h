#pragma once

#include "dem/specimen/neighbours.h"

#include <cstdint>
#include <numeric>
#include <vector>

namespace feldspar
{
/// Contacts of each grain: 2 × contact + (0: as grain 1, 1: as grain 2), in one order, so that sums over them have one.
struct Incidence
{
  std::vector<std::uint32_t> first;   ///< of each grain's among the entries; [n_grains + 1]
  std::vector<std::uint32_t> entries; ///< [2 n_contacts]
};

/// ends_of(contact) is a pair of grains; the second may be an image, which owner_of() leads back to its grain.
template <typename EndsOf, typename OwnerOf>
Incidence incidence(const std::size_t n_grains, const std::size_t n_contacts, EndsOf&& ends_of, OwnerOf&& owner_of)
{
  Incidence result;
  result.first.assign(n_grains + 1, 0);
  for (std::size_t k = 0; k < n_contacts; ++k)
    {
      const GrainPair ends = ends_of(k);
      ++result.first[ends.first + 1];
      ++result.first[owner_of(ends.second) + 1];
    }
  std::partial_sum(result.first.begin(), result.first.end(), result.first.begin());
  auto next = result.first;
  result.entries.resize(2 * n_contacts);
  for (std::size_t k = 0; k < n_contacts; ++k)
    {
      const GrainPair ends = ends_of(k);
      result.entries[next[ends.first]++] = std::uint32_t(2 * k);
      result.entries[next[owner_of(ends.second)]++] = std::uint32_t(2 * k + 1);
    }
  return result;
}
} // namespace feldspar

#pragma once

#include "dem/storage/grains.h"

#include <cstdint>
#include <functional>
#include <utility>
#include <vector>

namespace feldspar
{
using GrainPair = std::pair<std::uint32_t, std::uint32_t>; ///< first < second

/// Every pair whose gap (centre distance less both radii) is below `largest_gap` [m], in ascending order. `check` is called
/// now and then, for millions of grains take seconds, and may throw to end the search.
template <int dim>
std::vector<GrainPair> pairs_within(
  const Grains<dim>& grains, double largest_gap, const std::function<void()>& check = [] {});

/// Calls `visit` with each pair of pairs_within(), in the same order, without a list of all: a visitor may end the search by
/// a throw where there would be too many.
template <int dim>
void for_each_pair_within(const Grains<dim>& grains, double largest_gap,
                          const std::function<void(const GrainPair&)>& visit, const std::function<void()>& check);

/// Numbers of the grains along a Z-curve: neighbours in space come near each other in memory.
template <int dim>
std::vector<std::uint32_t> spatial_order(const Grains<dim>& grains);
} // namespace feldspar

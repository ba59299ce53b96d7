#pragma once

#include "dem/specimen/neighbours.h"

namespace feldspar
{
/// Calls `visit` with each pair of pairs_within(), in the same order, without a list of all: a visitor may end the search by
/// a throw where there would be too many.
template <int dim>
void for_each_pair_within(const Grains<dim>& grains, double largest_gap,
                          const std::function<void(const GrainPair&)>& visit, const std::function<void()>& check);
} // namespace feldspar

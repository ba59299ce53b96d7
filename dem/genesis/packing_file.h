#pragma once

#include "dem/specimen/neighbours.h"
#include "dem/specimen/parameters.h"
#include "dem/storage/grains.h"

#include <functional>
#include <vector>

namespace feldspar
{
/// Grains made elsewhere, and the pairs of them that are to be joined; no pairs: those that come near enough are.
template <int dim>
struct Packing
{
  Grains<dim> grains;
  std::vector<GrainPair> bonds;
};

/// Reads a packing made elsewhere (packing_table.h), in the box [0, width] × [0, height]; into a periodic cell grains outside
/// come in from the other side. Throws InputError with the line of whatever is not so, or of grains that overlap by more than
/// 5 % of the smaller radius. `check` is called now and then and may throw to end it.
template <int dim>
Packing<dim> read_packing(
  const SpecimenParameters& wanted, const std::function<void()>& check = [] {});
} // namespace feldspar

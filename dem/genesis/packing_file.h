#pragma once

#include "dem/specimen/parameters.h"
#include "dem/storage/grains.h"

#include <functional>

namespace feldspar
{
/// Reads a packing made elsewhere (packing_table.h), in the box [0, width] × [0, height]. Throws InputError with the line of
/// whatever is not so, or of grains that overlap by more than 5 % of the smaller radius. `check` is called now and then and may throw to end it.
template <int dim>
Grains<dim> read_packing(
  const SpecimenParameters& wanted, const std::function<void()>& check = [] {});
} // namespace feldspar

#pragma once

#include "dem/specimen/parameters.h"
#include "dem/storage/grains.h"

namespace feldspar
{
/// Reads a packing made elsewhere: lines `x y [z] radius` in metres, in the box [0, width] × [0, height]; # begins a
/// comment. Throws InputError with the line of whatever is not so, or of grains that overlap by more than 5 % of the
/// smaller radius.
template <int dim>
Grains<dim> read_packing(const SpecimenParameters& wanted);
} // namespace feldspar

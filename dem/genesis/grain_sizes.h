#pragma once

#include "dem/specimen/parameters.h"

#include <cstdint>
#include <vector>

/// The sizes of the grains to be packed: drawn between the smallest and the largest radius, or by a sieve curve.
namespace feldspar
{
/// Expected number of grains in a solid volume [m³], in the plane an area [m²].
double expected_number(const SpecimenParameters& wanted, double solid);

/// Radii [m], as many as fill the solid volume [m³] best; by a sieve curve so many of each class.
template <int dim>
std::vector<double> draw_radii(const SpecimenParameters& wanted, double solid, double thickness, std::uint64_t seed);
} // namespace feldspar

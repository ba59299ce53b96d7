#pragma once

#include "dem/specimen/specimen.h"

#include <functional>

namespace feldspar
{
/// Brings grains that were thrown into their box, cylinder or periodic cell to rest under frictionless contacts and walls
/// at a mean stress [Pa, compression positive] by descent: positions and the logarithm of the radius multiplier move
/// together to where forces balance and the stress is the wanted one, from the dense side; docs/theory.md §3. Leaves
/// radii and positions, grains in spatial order, without mass; stress and multiplier stand in the report. `check` is called
/// at every iteration, `check_within` in the searches for neighbours too; both may throw to end it. Throws InputError
/// where no rest is found.
template <int dim>
void pack_by_descent(Specimen<dim>& loose, double stress, const std::function<void()>& check,
                     const std::function<void()>& check_within);
} // namespace feldspar

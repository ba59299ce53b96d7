#pragma once

#include "dem/dynamics/dynamics.h"

namespace feldspar
{
/// Moves a wall so that its pressure comes to a target: v = e + I with e = G (P_0 - P), I += 0.05 e, both within
/// ±largest_speed; docs/theory.md §4.3. The proportional part alone lags behind a specimen that widens steadily.
template <int dim>
void hold_pressure(Dynamics<dim>& dynamics, std::size_t wall, double area, double target, double largest_speed);
} // namespace feldspar

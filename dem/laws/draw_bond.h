#pragma once

#include "base/random.h"
#include "dem/laws/bond_strength.h"

#include <cmath>

namespace feldspar
{
/// The strengths of one bond from their normal distributions, tension first.
template <typename Parameters>
Bond<double> draw_bond(const Parameters& wanted, Random& random)
{
  const double tensile_strength =
    random.non_negative_normal(wanted.bond_tensile_strength, wanted.bond_tensile_strength_deviation);
  const double cohesion = random.non_negative_normal(wanted.bond_cohesion, wanted.bond_cohesion_deviation);
  return {tensile_strength, cohesion, std::tan(wanted.bond_friction_angle)};
}
} // namespace feldspar

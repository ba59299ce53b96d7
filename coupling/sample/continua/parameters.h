#pragma once

#include "base/entries.h"

#include <numbers>
#include <vector>

namespace feldspar
{
/// A material without grains, for comparison. Modulus and Poisson's ratio are those that a test shows; in a plane sample:
/// with the out-of-plane direction free.
struct ContinuumParameters
{
  double modulus = 62.5e9; ///< [Pa]
  double poissons_ratio = 0.16;
  double cohesion = 30e6;                                  ///< [Pa]
  double friction_angle = 50.0 * std::numbers::pi / 180.0; ///< [rad]
  double dilation_angle = 10.0 * std::numbers::pi / 180.0; ///< [rad]
};

/// The entries of section Continuum.
inline std::vector<Entry<ContinuumParameters>> continuum_entries()
{
  using P = ContinuumParameters;
  return {entry::quantity("Modulus", &P::modulus, Measure::stress, "GPa", ranges::above_zero,
                          "Young's; as a test in the plane shows it (free across the plane)", {.basic = true}),
          entry::number("Poisson ratio", &P::poissons_ratio, {'[', 0.0, 1.0, ')'}, "as a test in the plane shows it",
                        {.basic = true}),
          entry::quantity("Cohesion", &P::cohesion, Measure::stress, "MPa", ranges::above_zero,
                          "of Mohr-Coulomb; there is no softening", {.basic = true}),
          entry::quantity("Friction angle", &P::friction_angle, Measure::angle, "deg", {'(', 0.0, 90.0, ')'},
                          "of Mohr-Coulomb", {.basic = true}),
          entry::quantity("Dilation angle", &P::dilation_angle, Measure::angle, "deg", {'[', 0.0, 90.0, ')'},
                          "of Mohr-Coulomb; at most Friction angle")};
}
} // namespace feldspar

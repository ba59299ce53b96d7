#pragma once

#include <numbers>

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
} // namespace feldspar

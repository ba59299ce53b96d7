#pragma once

#include <optional>

/// Parameters that single tests, or two of them, have of their own.
namespace feldspar
{
/// The splitting of a disc.
struct BrazilianParameters
{
  double strain_rate = 0.164; ///< of the diameter, magnitude [1/s]
  double sampling_strain = 2e-6;
  double length_ratio = 0.5; ///< length of the disc, or half disc, over its diameter, in space
};

/// The halves of a box that move past each other.
struct ShearParameters
{
  double strain_rate = 0.1; ///< of the shear displacement over the length of the plane [1/s]
  double sampling_strain = 1e-5;
  std::optional<double> normal_stiffness; ///< of the rock around the plane [Pa/m]; none: constant normal stress
};

/// The pace of the plate.
struct TiltParameters
{
  double strain_rate = 100.0;    ///< of the tilt [rad/s]
  double sampling_strain = 2e-3; ///< tilt between two rows of the curve [rad]
};
} // namespace feldspar

#pragma once

#include <optional>

namespace feldspar
{
/// The halves of a box that move past each other.
struct ShearParameters
{
  double strain_rate = 0.1; ///< of the shear displacement over the length of the plane [1/s]
  double sampling_strain = 1e-5;
  std::optional<double> normal_stiffness; ///< of the rock around the plane [Pa/m]; none: constant normal stress
};
} // namespace feldspar

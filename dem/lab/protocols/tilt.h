#pragma once

#include "laboratory/parameters.h"

namespace feldspar
{
/// The pace of the plate.
struct TiltParameters
{
  double strain_rate = 100.0;    ///< of the tilt [rad/s]
  double sampling_strain = 2e-3; ///< tilt between two rows of the curve [rad]
};

/// Throws InputError where a body of this width and height [m] would not be pressed on the plate of the tilt test by its
/// weight, or would slide or topple at once.
void check_tilt(const TestParameters& wanted, double width, double height);
} // namespace feldspar

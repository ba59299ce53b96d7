#pragma once

#include <span>

namespace feldspar
{
/// A contact with a plate that turns about a pivot. It presses where overlap - tilt × lever is positive.
struct SpringOnPlate
{
  double stiffness; ///< [N/m]
  double lever;     ///< from the pivot, along the plate [m]
  double overlap;   ///< with the plate level [m]
};

/// The tilt [rad] at which the contacts press without a moment about the pivot, where their energy is least. Where none
/// presses over a range of tilts, the nearest of these to `before`.
double balanced_tilt(std::span<const SpringOnPlate> springs, double before);
} // namespace feldspar

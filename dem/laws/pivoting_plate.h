#pragma once

#include <algorithm>
#include <cmath>
#include <limits>
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
/// presses over a range of tilts, the nearest of these to `before`. Bisection alone comes to rounding in some 50 trials.
inline double balanced_tilt(const std::span<const SpringOnPlate> springs, const double before,
                            const int most_trials = 100)
{
  // With more tilt, contacts beyond the pivot open, and those before it come to press: the moment falls, linearly from
  // one such change to the next.
  constexpr double infinity = std::numeric_limits<double>::infinity();
  double all_beyond_off = -infinity;
  double all_before_off = infinity;
  for (const auto& spring : springs)
    if (spring.lever > 0.0)
      all_beyond_off = std::max(all_beyond_off, spring.overlap / spring.lever);
    else if (spring.lever < 0.0)
      all_before_off = std::min(all_before_off, spring.overlap / spring.lever);
  if (all_beyond_off <= all_before_off)
    return std::clamp(before, all_beyond_off, all_before_off);

  // Newton's method, which ends with the right contacts; bisection where it would leave the bracket. It has come to an end
  // where the moment is that of the rounding of its terms, which are larger than their difference, the overlap.
  constexpr double rounding = 1e-14;
  double least = all_before_off;
  double most = all_beyond_off;
  double tilt = std::clamp(before, least, most);
  for (int trial = 0; trial < most_trials; ++trial)
    {
      double moment = 0.0;
      double size = 0.0;
      double resistance = 0.0;
      for (const auto& spring : springs)
        if (const double overlap = spring.overlap - tilt * spring.lever; overlap > 0.0)
          {
            const double stiffness = spring.stiffness * spring.lever;
            moment += stiffness * overlap;
            size += std::abs(stiffness) * (std::abs(spring.overlap) + std::abs(tilt * spring.lever));
            resistance += stiffness * spring.lever;
          }
      if (std::abs(moment) <= rounding * size)
        break;
      (moment > 0.0 ? least : most) = tilt;
      const double next = tilt + moment / resistance;
      tilt = next > least && next < most ? next : 0.5 * (least + most);
    }
  return tilt;
}
} // namespace feldspar

#pragma once

#include "laboratory/energies.h"

#include <algorithm>
#include <cmath>

namespace feldspar
{
/// Sees from row to row of a curve whether a body has more energy than it was given.
class EnergyWatch
{
public:
  /// Returns whether more has been stored and dissipated than twice what was put in, at the most there has been until
  /// now. The scheme itself leaves a thousandth of that open. Energies that are no numbers count as grown.
  bool has_grown_without_work(const Energies& now)
  {
    most_put_in = std::max(most_put_in, std::abs(now.boundary_work) + now.kinetic_at_start);
    constexpr double round_off = 4e-21; // of a body at rest: k_B T of a room [J]
    return !(-now.unaccounted() <= most_put_in + round_off);
  }

private:
  double most_put_in = 0.0; ///< [J]
};
} // namespace feldspar

#pragma once

#include <cmath>

namespace feldspar
{
/// Energies since the start of the test, kinetic energy as it is [J]; each integrated on its own, none is the remainder
/// of the others. NaN where they are not known.
struct Energies
{
  double boundary_work = 0.0;
  double kinetic = 0.0;
  double strain = 0.0;
  double slip = 0.0;
  double released = 0.0; ///< by bonds that break or soften
  double damping = 0.0;
  double kinetic_at_start = 0.0; ///< of the motion that the grains were set off with
  double redistribution = 0.0;   ///< set free between finite elements on their way to equilibrium after breaks

  /// Boundary work and the energy at the start less all they went into [J].
  double unaccounted() const
  {
    return boundary_work + kinetic_at_start - kinetic - strain - slip - released - damping - redistribution;
  }
  /// |unaccounted| over the sum of all terms.
  double imbalance() const
  {
    const double terms = std::abs(boundary_work) + std::abs(kinetic) + std::abs(strain) + std::abs(slip) +
                         std::abs(released) + std::abs(damping) + std::abs(kinetic_at_start) + std::abs(redistribution);
    return terms != 0.0 ? std::abs(unaccounted()) / terms : 0.0;
  }
  /// |unaccounted| over the boundary work.
  double imbalance_over_work() const { return boundary_work != 0.0 ? std::abs(unaccounted() / boundary_work) : 0.0; }
};
} // namespace feldspar

#pragma once

#include "base/entries.h"
#include "dem/dynamics/parameters.h"

#include <vector>

/// The entries of the dynamics.
namespace feldspar
{
/// The entries of section Dynamics.
inline std::vector<Entry<DynamicsParameters>> dynamics_entries()
{
  using P = DynamicsParameters;
  const EntryFlags varies{.varies = true};
  return {entry::number("Damping", &P::damping, {'[', 0.0, 1.0, ')'},
                        "local non-viscous: share of the unbalanced force set against the motion", varies),
          entry::number("Time step safety", &P::time_step_safety, {'(', 0.0, 1.0, ']'},
                        "time step over the least root of mass over stiffness", varies)};
}
} // namespace feldspar

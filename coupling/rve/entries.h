#pragma once

#include "base/entries.h"
#include "coupling/rve/parameters.h"

#include <vector>

/// The entries of a representative volume.
namespace feldspar
{
/// The entries of section Representative volume.
inline std::vector<Entry<EquilibriumParameters>> equilibrium_entries()
{
  using P = EquilibriumParameters;
  const EntryFlags varies{.varies = true};
  return {entry::number("Event tolerance", &P::event_tolerance, {'[', 1e-12, 0.1, ']'},
                        "largest unbalanced over mean contact force, between breaks", varies),
          entry::number("Final tolerance", &P::final_tolerance, {'[', 1e-12, 0.1, ']'},
                        "the same, of the stress that is handed out", varies),
          entry::choice("Break rule", &P::break_rule,
                        {{"near worst", BreakRule::near_worst}, {"only worst", BreakRule::only_worst}},
                        "whether segments with 0.98 of the worst overload break together with it", varies),
          entry::integer("Most iterations", &P::most_iterations, {'[', 1.0, 1e6, ']'},
                         "by Newton's method in search of one equilibrium, before damped motion brings it nearer",
                         varies)};
}
} // namespace feldspar

#pragma once

#include "coupling/rve/network_history.h"
#include "coupling/rve/parameters.h"

#include <vector>

/// Rules by which segments break; docs/theory.md §9.3.
namespace feldspar
{
/// A segment beyond its strength, or, where its bond softens, beyond what is left of it.
struct Overload
{
  double ratio; ///< max(σ̂/σ_b, |τ|/τ_c), or SofteningDemand::ratio
  std::uint32_t segment;
  bool in_tension;
};

/// Largest number of events of a bond until it has broken.
template <int dim>
unsigned int most_events_of_a_bond(const Network<dim>& network, const EquilibriumParameters& parameters);

/// Segments with bonds that are overloaded where the network stands, as many as break at once by the rule.
template <int dim>
std::vector<Overload> overloads(const NetworkHistory<dim>& history, const Configuration<dim>& present,
                                const EquilibriumParameters& parameters);

/// The share of the way since the last event, taken as straight, at which the first of these is overloaded.
template <int dim>
double share_until(const std::vector<Overload>& overloads, const NetworkHistory<dim>& history,
                   const Configuration<dim>& present, const EquilibriumParameters& parameters);
} // namespace feldspar

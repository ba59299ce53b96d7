#pragma once

#include "coupling/network/network.h"

#include <array>
#include <cstdint>
#include <vector>

namespace feldspar
{
/// A segment without a bond, and the shear stress it carries.
template <int dim>
struct UnbondedSegment
{
  std::uint32_t segment;
  std::array<double, dim - 1> shear_stress; ///< [Pa]
};

/// Softening values that a bond stores (softening::State::more); 0 for a bond that has not softened.
using Memory = std::array<double, 3>;

/// A segment whose bond holds and has softened.
template <int dim>
struct SoftenedSegment
{
  std::uint32_t segment;
  std::array<double, dim - 1> shear_stress; ///< [Pa]
  Memory more;
};

/// Works since the RVE was at rest [J], each summed on its own.
struct NetworkWork
{
  double boundary = 0.0; ///< ∫ V σ : dε
  double slip = 0.0;     ///< by friction of broken segments
  double released = 0.0; ///< stored in segments at the moment they broke, or given up by bonds that soften
  double settled = 0.0;  ///< done by unbalanced forces on the way to equilibrium after a break
};

/// All that a copy of a representative volume keeps. While it is intact the strain says everything.
template <int dim>
struct NetworkState
{
  Voigt<dim> strain = Voigt<dim>::Zero();
  Voigt<dim> stress = Voigt<dim>::Zero();     ///< [Pa]
  bool intact = true;                         ///< and linear
  std::vector<double> motions;                ///< of all grains; empty while intact
  std::vector<UnbondedSegment<dim>> unbonded; ///< ascending; pairs without a face where they are in contact
  std::vector<SoftenedSegment<dim>> softened; ///< ascending
  /// The shear stress of every segment, by a law that is not linear while it holds [Pa]; empty at rest and otherwise.
  std::vector<std::array<double, dim - 1>> contact_shear;
  std::uint32_t n_tension_breaks = 0;
  std::uint32_t n_shear_breaks = 0;
  NetworkWork work;
};

template <int dim>
Unknowns unknowns_of(const Network<dim>& network, const NetworkState<dim>& state)
{
  if (state.motions.empty())
    return network.intact_unknowns(state.strain);
  Unknowns unknowns(network.n_unknowns());
  unknowns << Eigen::Map<const Eigen::VectorXd>(state.motions.data(), Eigen::Index(state.motions.size())), state.strain;
  return unknowns;
}
} // namespace feldspar

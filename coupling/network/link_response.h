#pragma once

#include "coupling/network/network_state.h"
#include "dem/laws/flat_joint_law.h"

/// Response of a link that has unbonded or softened segments, or whose law is not linear while it holds: the law of
/// dem/, in small strains and from one event to the next; docs/theory.md §9.3.
namespace feldspar
{
/// One segment at the last event.
template <int dim>
struct SegmentHistory
{
  bool bonded = true;
  /// Shear stress without a bond, or with one that has softened; of a parallel bond, whether it holds or not, the shear
  /// force of its contact over its area [Pa].
  std::array<double, dim - 1> shear_stress{};
  Memory more{}; ///< of a bond that holds

  bool has_softened() const { return bonded && more.front() > 0.0; }
};

/// A link with segments that are unbonded or have softened, and how it stood at the last event.
template <int dim>
struct ActiveLink
{
  std::uint32_t link;
  Motion<dim> motion; ///< at the last event
  std::vector<SegmentHistory<dim>> segments;
};

/// One segment now.
template <int dim>
struct SegmentResponse
{
  std::array<double, dim - 1> shear_stress{}; ///< as in the history
  BondStress bond_stress{};                   ///< of a bonded one that has not softened
  std::array<double, dim - 1> slip{};         ///< shear since the last event that τ did not follow, along τ [m]
};

template <int dim>
struct LinkResponse
{
  Motion<dim> forces = Motion<dim>::Zero();                  ///< work-conjugate to the link's motion
  JointStiffness<dim> tangent = JointStiffness<dim>::Zero(); ///< bonds and open, stick, slip states frozen
  /// Derivative of the forces: what slides drags with its pressure, what closes late sticks late. Not symmetric.
  JointStiffness<dim> derivative = JointStiffness<dim>::Zero();
  std::vector<SegmentResponse<dim>> segments;
  double stored_energy = 0.0; ///< [J]
};

/// `motion` of the link now. The memory of an earlier response can serve again.
template <int dim>
LinkResponse<dim> response(const Network<dim>& network, const ActiveLink<dim>& active, const Motion<dim>& motion,
                           LinkResponse<dim> memory = {});

/// Demand on a bond that has softened to soften farther.
struct SofteningDemand
{
  double ratio;  ///< of what is asked of it to what it carries, as overload_ratio() of one that has not softened
  bool exceeded; ///< by at least half a step
};

/// Demand on segment i of a link, opened since rest, under a shear stress computed as if it did not soften.
/// `least_step` is that of the number d of theory §1.10.
template <int dim>
SofteningDemand softening_demand(const Network<dim>& network, const Link<dim>& link, std::uint32_t i,
                                 const SegmentHistory<dim>& old, double opening,
                                 const std::array<double, dim - 1>& shear_stress, double least_step);

/// Result of the event of an overloaded bond.
struct BondEvent
{
  bool broke; ///< else it softened
  bool in_tension;
  double slip_energy;     ///< of friction, while it softened [J]
  double released_energy; ///< of a softening bond that broke: all that it has given up [J]
};

/// The overloaded bond of segment i breaks where its link stands at the last event, or softens, by half a step farther than is
/// asked of it. in_tension: how a bond breaks that does not soften.
template <int dim>
BondEvent loosen(const Network<dim>& network, ActiveLink<dim>& active, std::uint32_t i, bool in_tension,
                 double least_step);
} // namespace feldspar

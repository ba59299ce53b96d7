#pragma once

#include "coupling/network/network.h"
#include "dem/laws/flat_joint_law.h"

/// How a link with unbonded segments, or one of a law that is not linear while it holds, responds: the law of dem/, in small
/// strains and from one event to the next; docs/theory.md §9.3.
namespace feldspar
{
/// One segment at the last event.
template <int dim>
struct SegmentHistory
{
  bool bonded = true;
  /// Without a bond; of a parallel bond, whether it holds or not, the shear force of its contact over its area [Pa].
  std::array<double, dim - 1> shear_stress{};
};

/// A link with unbonded segments and how it stood at the last event.
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
  std::array<double, dim - 1> shear_stress; ///< as in the history
  BondStress bond_stress{};                 ///< of a bonded one
  std::array<double, dim - 1> slip{};       ///< shear since the last event that τ did not follow, along τ [m]
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

/// `motion` of the link now.
template <int dim>
LinkResponse<dim> response(const Network<dim>& network, const ActiveLink<dim>& active, const Motion<dim>& motion);
} // namespace feldspar

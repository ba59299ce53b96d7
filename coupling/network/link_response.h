#pragma once

#include "coupling/network/network.h"
#include "dem/laws/flat_joint_law.h"

/// How a link with unbonded segments answers: the flat-joint law of dem/, in small strains and from one event to the
/// next; docs/theory.md §10.3.
namespace feldspar
{
/// One segment at the last event.
template <int dim>
struct SegmentHistory
{
  bool bonded = true;
  std::array<double, dim - 1> shear_stress{}; ///< [Pa]; of an unbonded one
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
struct SegmentAnswer
{
  double normal_stress;                     ///< σ̂ [Pa]
  std::array<double, dim - 1> shear_stress; ///< τ [Pa]
  std::array<double, dim - 1> slip{};       ///< shear since the last event that τ did not follow, along τ [m]
};

template <int dim>
struct LinkAnswer
{
  Motion<dim> forces = Motion<dim>::Zero();                  ///< work-conjugate to the link's motion
  JointStiffness<dim> tangent = JointStiffness<dim>::Zero(); ///< bonds and open, stick, slip states frozen
  /// Derivative of the forces: what slides drags with its pressure, what closes late sticks late. Not symmetric.
  JointStiffness<dim> derivative = JointStiffness<dim>::Zero();
  std::vector<SegmentAnswer<dim>> segments;
  double stored_energy = 0.0; ///< [J]
};

/// `motion` of the link now.
template <int dim>
LinkAnswer<dim> answer(const Network<dim>& network, const ActiveLink<dim>& active, const Motion<dim>& motion);
} // namespace feldspar

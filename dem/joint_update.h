#pragma once

#include "dem/contact_motion.h"
#include "dem/flat_joint_law.h"

#include <vector>

/// The face of a joint: its segments, answered one by one by the law, and their resultants (7), (9).
namespace feldspar
{
/// How a face moves over a step.
template <int dim, typename Real>
struct FaceMotion
{
  Real opening_before;                       ///< g_0 + U_n at the start [m]
  Real opening;                              ///< at the end [m]
  Real slope_before;                         ///< θ at the start [rad]
  Real slope;                                ///< θ at the end [rad]
  std::array<Real, dim - 1> shear_increment; ///< ΔU_s [m]
};

/// F_n, F_s and M_c about the contact point.
template <int dim, typename Real>
struct FaceResultants
{
  Real normal_force;                     ///< compression positive [N]
  std::array<Real, dim - 1> shear_force; ///< [N]
  Real moment;                           ///< [N m]
  Real slip_energy;                      ///< dissipated in this step [J]
};

/// Updates all segments of a face. `segments` gives each one's bond and old state and takes its update:
///   Bond<Real> bond(i);  SegmentState<dim, Real> state(i);  void set(i, SegmentUpdate<dim, Real>)
template <typename Real, typename Segments>
FaceResultants<2, Real> update_face(const flat_joint::Face<Real>& face, const unsigned int n_segments,
                                    const FaceMotion<2, Real>& motion, Segments&& segments)
{
  const Real half_length = 0.5 * double(n_segments) * face.segment_length;
  FaceResultants<2, Real> sum{Real(0.0), {Real(0.0)}, Real(0.0), Real(0.0)};
  for (unsigned int i = 0; i < n_segments; ++i)
    {
      const Real rho = flat_joint::segment_offset(i, n_segments, half_length);
      const auto update = flat_joint::update<2, Real>(
        face, segments.bond(i), segments.state(i),
        {flat_joint::gap_at(motion.opening_before, motion.slope_before, rho),
         flat_joint::gap_at(motion.opening, motion.slope, rho), motion.slope, motion.shear_increment});
      segments.set(i, update);
      sum.normal_force += update.normal.force;
      sum.shear_force[0] += update.state.shear_stress[0] * face.segment_area();
      sum.moment += update.normal.moment - rho * update.normal.force; // (9)
      sum.slip_energy += update.slip_energy;
    }
  return sum;
}
} // namespace feldspar

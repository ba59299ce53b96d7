#pragma once

#include "dem/laws/contact_motion.h"
#include "dem/laws/face_elements.h"
#include "dem/laws/flat_joint_law.h"

#include <vector>

/// The face of a joint: its segments, answered one by one by the law, and their resultants (7), (9).
namespace feldspar
{
/// What the segments of a face have in common.
template <typename Real>
struct Face
{
  Real normal_stiffness; ///< k_n [Pa/m]
  Real shear_stiffness;  ///< k_s [Pa/m]
  Real half_length;      ///< R̄ [m]
  double thickness;      ///< t of the plane [m]
  double friction;       ///< μ [-]
};

/// Segment of a face, and where its centroid lies.
template <int dim, typename Real>
struct PlacedSegment
{
  flat_joint::Segment<dim, Real> segment;
  std::array<Real, dim - 1> offset; ///< ρ along t, or r along t_1 and t_2 [m]
};

template <int dim, typename Real>
PlacedSegment<dim, Real> place_segment(const Face<Real>& face, const FaceElement<dim>& element)
{
  const Real r = face.half_length;
  if constexpr (dim == 2)
    return {{face.normal_stiffness, face.shear_stiffness, r * element.area, face.thickness, face.friction},
            {r * element.offset[0]}};
  else
    return {{face.normal_stiffness, face.shear_stiffness, r * r * element.area, face.friction},
            {r * element.offset[0], r * element.offset[1]}};
}

/// How a face moves over a step.
template <int dim, typename Real>
struct FaceMotion
{
  Real opening_before;                                ///< g_0 + U_n at the start [m]
  Real opening;                                       ///< at the end [m]
  std::array<Real, n_rotations<dim>> rotation_before; ///< θ at the start: about k, or n, t_1 and t_2 [rad]
  std::array<Real, n_rotations<dim>> rotation;        ///< θ at the end [rad]
  std::array<Real, dim - 1> slip_increment;           ///< ΔU_s at the contact point [m]
};

/// F_n, F_s and M_c about the contact point.
template <int dim, typename Real>
struct FaceResultants
{
  Real normal_force;                         ///< compression positive [N]
  std::array<Real, dim - 1> shear_force;     ///< [N]
  std::array<Real, n_rotations<dim>> moment; ///< about k, or n, t_1 and t_2 [N m]
  Real slip_energy;                          ///< dissipated in this step [J]
};

/// Adds a segment's forces and, about the contact point, their moment: (9), in three dimensions r × F.
template <typename Real>
void add_segment(FaceResultants<2, Real>& sum, const std::array<Real, 1>& offset, const Real& area,
                 const flat_joint::SegmentUpdate<2, Real>& update)
{
  sum.normal_force += update.normal.force;
  sum.shear_force[0] += update.state.shear_stress[0] * area;
  sum.moment[0] += update.normal.moment - offset[0] * update.normal.force; // (9)
  sum.slip_energy += update.slip_energy;
}

template <typename Real>
void add_segment(FaceResultants<3, Real>& sum, const std::array<Real, 2>& offset, const Real& area,
                 const flat_joint::SegmentUpdate<3, Real>& update)
{
  const Real shear_1 = update.state.shear_stress[0] * area;
  const Real shear_2 = update.state.shear_stress[1] * area;
  sum.normal_force += update.normal.force;
  sum.shear_force[0] += shear_1;
  sum.shear_force[1] += shear_2;
  sum.moment[0] += offset[0] * shear_2 - offset[1] * shear_1;
  sum.moment[1] += offset[1] * update.normal.force;
  sum.moment[2] -= offset[0] * update.normal.force;
  sum.slip_energy += update.slip_energy;
}

/// Updates all segments of a face. `segments` gives each one's bond and old state and takes its update:
///   Bond<Real> bond(i);  SegmentState<dim, Real> state(i);  void set(i, SegmentUpdate<dim, Real>)
template <int dim, typename Real, typename Segments>
FaceResultants<dim, Real> update_face(const Face<Real>& face, const std::vector<FaceElement<dim>>& elements,
                                      const FaceMotion<dim, Real>& motion, Segments&& segments)
{
  FaceResultants<dim, Real> sum{Real(0.0), {}, {}, Real(0.0)};
  sum.shear_force.fill(Real(0.0));
  sum.moment.fill(Real(0.0));
  const Real slope = dim == 2 ? motion.rotation[0] : Real(0.0);
  const Real twist = motion.rotation[0] - motion.rotation_before[0];
  for (unsigned int i = 0; i < elements.size(); ++i)
    {
      const auto [segment, offset] = place_segment(face, elements[i]);
      const auto update =
        flat_joint::update<dim, Real>(segment, segments.bond(i), segments.state(i),
                                      {flat_joint::gap_at(motion.opening_before, motion.rotation_before, offset),
                                       flat_joint::gap_at(motion.opening, motion.rotation, offset), slope,
                                       flat_joint::slip_at(motion.slip_increment, twist, offset)});
      segments.set(i, update);
      add_segment(sum, offset, segment.area(), update);
    }
  return sum;
}

/// Stored in the segments of a face [J]; a segment's shear stress and bond by its number.
template <int dim, typename ShearStressOf, typename BondedOf>
double face_energy(const Face<double>& face, const std::vector<FaceElement<dim>>& elements, const double opening,
                   const std::array<double, n_rotations<dim>>& rotation, ShearStressOf&& shear_stress_of,
                   BondedOf&& bonded_of)
{
  double sum = 0.0;
  for (unsigned int i = 0; i < elements.size(); ++i)
    {
      const auto [segment, offset] = place_segment(face, elements[i]);
      const std::array<double, dim - 1> tau = shear_stress_of(i);
      double squared = 0.0;
      for (const double component : tau)
        squared += component * component;
      sum += normal_energy(segment, flat_joint::gap_at(opening, rotation, offset), rotation[0], bonded_of(i));
      sum += 0.5 * squared * segment.area() / segment.shear_stiffness;
    }
  return sum;
}
} // namespace feldspar

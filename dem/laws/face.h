#pragma once

#include "base/vector.h"
#include "dem/laws/face_elements.h"

#include <array>

/// Input and output of any joint law: a face, its motion over a step, and its forces.
namespace feldspar
{
/// The common properties of the elements of a face.
template <typename Real>
struct Face
{
  Real normal_stiffness; ///< k_n [Pa/m]
  Real shear_stiffness;  ///< k_s [Pa/m]
  Real half_length;      ///< R̄ [m]
  double thickness;      ///< t of the plane [m]
  Real friction;         ///< μ [-]
};

/// Motion of a face over a step.
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

/// Motion of a face in small strains, from rest, and forces per motion, in its own axes: along n, t (n, t_1, t_2), then
/// the turn about the axis out of the plane (about n, t_1, t_2) [m, rad].
template <int dim>
inline constexpr int n_motions = dim + n_rotations<dim>;
template <int dim>
using Motion = Eigen::Matrix<double, n_motions<dim>, 1>;
template <int dim>
using JointStiffness = Eigen::Matrix<double, n_motions<dim>, n_motions<dim>>;

/// Rows that give the change of gap and the shear of an element from the motion of its face.
template <int dim>
using ElementRows = Eigen::Matrix<double, dim, n_motions<dim>>;

template <int dim>
ElementRows<dim> element_rows(const FaceElement<dim>& element, const double half_length)
{
  ElementRows<dim> rows = ElementRows<dim>::Zero();
  rows.template leftCols<dim>().setIdentity();
  if constexpr (dim == 2)
    rows(0, 2) = -half_length * element.offset[0]; // g = g_0 + U_n - θρ (6)
  else
    {
      const double r_1 = half_length * element.offset[0];
      const double r_2 = half_length * element.offset[1];
      rows(0, 4) = r_2; // g = g_0 + U_n + n·(θ × r)
      rows(0, 5) = -r_1;
      rows(1, 3) = -r_2;
      rows(2, 3) = r_1;
    }
  return rows;
}

/// [m²].
template <int dim>
double element_area(const FaceElement<dim>& element, const Face<double>& face)
{
  return element.area * face.half_length * (dim == 2 ? face.thickness : face.half_length);
}

/// Springs of a face as a whole against motions of it about its middle.
struct FaceSprings
{
  double normal;  ///< [N/m]
  double shear;   ///< [N/m]
  double bending; ///< [N m]
  double twist;   ///< [N m]; 0 in the plane
};

/// Springs of a face with the stiffnesses k_n and k_s per area.
template <int dim>
FaceSprings face_springs(const Face<double>& face)
{
  const double area = face_area<dim>(face.half_length, face.thickness);
  return {face.normal_stiffness * area, face.shear_stiffness * area,
          face.normal_stiffness * face_second_moment<dim>(face.half_length, face.thickness),
          face.shear_stiffness * face_polar_moment<dim>(face.half_length)};
}

/// Share of an element that sticks, by springs k_n and k_s per area, in the stiffness of its face.
template <int dim>
JointStiffness<dim> element_stiffness(const Face<double>& face, const FaceElement<dim>& element,
                                      const ElementRows<dim>& rows)
{
  const double area = element_area(element, face);
  JointStiffness<dim> stiffness = face.normal_stiffness * area * rows.row(0).transpose() * rows.row(0);
  stiffness += face.shear_stiffness * area * rows.bottomRows(dim - 1).transpose() * rows.bottomRows(dim - 1);
  if constexpr (dim == 2) // elements of a disk are lumped
    {
      const double r = face.half_length;
      stiffness(2, 2) += face.normal_stiffness * (element.second_moment * r * r * r * face.thickness);
    }
  return stiffness;
}
} // namespace feldspar

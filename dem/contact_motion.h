#pragma once

#include "dem/simd.h"

#include <array>
#include <cmath>

/// How the contact plane of two grains moves over a step; docs/theory.md §1. Real is double or a pack of doubles.
namespace feldspar
{
/// The exact angle from one unit vector to another, given sine and cosine [rad].
inline double angle_turned(const double sine, const double cosine)
{
  // Steps turn by millionths: the series of the arc sine is exact to round-off there and vectorises.
  if (std::abs(sine) < 0.01 && cosine > 0.0)
    {
      const double s2 = sine * sine;
      return sine * (1.0 + s2 * (1.0 / 6.0 + s2 * (3.0 / 40.0 + s2 * (15.0 / 336.0))));
    }
  return std::atan2(sine, cosine);
}

inline simd::Pack angle_turned(const simd::Pack& sine, const simd::Pack& cosine)
{
  const simd::Pack s2 = sine * sine;
  simd::Pack angle = sine * (1.0 + s2 * (1.0 / 6.0 + s2 * (3.0 / 40.0 + s2 * (15.0 / 336.0))));
  if (simd::any(!(simd::absolute(sine) < 0.01 && cosine > 0.0)))
    angle = simd::Pack([&](const auto i) { return angle_turned(double(sine[i]), double(cosine[i])); });
  return angle;
}

/// Unit normal from grain 1 to grain 2 and the distance of their centres [m].
template <int dim, typename Real>
struct ContactFrame
{
  std::array<Real, dim> normal;
  Real distance;
};

template <int dim, typename Real>
ContactFrame<dim, Real> contact_frame(const std::array<Real, dim>& centre_1, const std::array<Real, dim>& centre_2)
{
  ContactFrame<dim, Real> frame;
  Real squared(0.0);
  for (int c = 0; c < dim; ++c)
    {
      frame.normal[c] = centre_2[c] - centre_1[c];
      squared += frame.normal[c] * frame.normal[c];
    }
  frame.distance = simd::square_root(squared);
  const Real inverse = 1.0 / frame.distance;
  for (int c = 0; c < dim; ++c)
    frame.normal[c] *= inverse;
  return frame;
}

/// ΔU_s = d̄ Δψ - a_1 Δφ_1 - a_2 Δφ_2 [m], along t, in two dimensions. Exact for finite turns: a rigid rotation of the
/// pair gives zero, since a_1 + a_2 = d̄ in the mean configuration.
/// half_radius_difference: ½(R1 - R2), which places the contact in the middle of overlap or gap.
template <typename Real>
std::array<Real, 1> slip_increment(const ContactFrame<2, Real>& before, const ContactFrame<2, Real>& now,
                                   const Real& half_radius_difference, const std::array<Real, 1>& turn_1,
                                   const std::array<Real, 1>& turn_2)
{
  const Real sine = before.normal[0] * now.normal[1] - before.normal[1] * now.normal[0];
  const Real cosine = before.normal[0] * now.normal[0] + before.normal[1] * now.normal[1];
  const Real mean_distance = 0.5 * (before.distance + now.distance);
  const Real a_1 = 0.5 * mean_distance + half_radius_difference;
  const Real a_2 = 0.5 * mean_distance - half_radius_difference;
  return {mean_distance * angle_turned(sine, cosine) - a_1 * turn_1[0] - a_2 * turn_2[0]};
}

/// Force on grain 2 and the couples on both grains.
template <int dim, typename Real>
struct ContactForce
{
  std::array<Real, dim> force;                  ///< on grain 2, its opposite on grain 1 [N]
  std::array<Real, dim*(dim - 1) / 2> couple_1; ///< [N m]
  std::array<Real, dim*(dim - 1) / 2> couple_2; ///< [N m]
};

/// Brings normal force (compression positive), shear force and couple at the contact point to both centres.
template <typename Real>
ContactForce<2, Real> contact_force(const ContactFrame<2, Real>& frame, const Real& half_radius_difference,
                                    const Real& normal_force, const std::array<Real, 1>& shear_force,
                                    const Real& moment)
{
  const auto& n = frame.normal;
  const Real a_1 = 0.5 * frame.distance + half_radius_difference;
  const Real a_2 = 0.5 * frame.distance - half_radius_difference;
  return {{normal_force * n[0] - shear_force[0] * n[1], normal_force * n[1] + shear_force[0] * n[0]},
          {-moment - a_1 * shear_force[0]},
          {moment - a_2 * shear_force[0]}};
}
} // namespace feldspar

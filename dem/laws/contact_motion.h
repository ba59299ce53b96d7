#pragma once

#include "base/simd.h"
#include "base/vector.h"

#include <array>
#include <cmath>

/// Motion of the contact plane of two grains over a step; docs/theory.md §1.2. Real is double or a pack of doubles.
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

/// Distances of the contact from both centres [m].
template <typename Real>
struct Arms
{
  Real one; ///< a_1
  Real two; ///< a_2
};

/// half_radius_difference: ½(R1 - R2), which places the contact in the middle of overlap or gap.
template <typename Real>
Arms<Real> arms(const Real& distance, const Real& half_radius_difference)
{
  return {0.5 * distance + half_radius_difference, 0.5 * distance - half_radius_difference};
}

/// The contact plane: unit normal from grain 1 to grain 2 and the distance of their centres [m]. In the plane its
/// tangent t is n turned by +90°.
template <int dim, typename Real>
struct ContactFrame
{
  std::array<Real, dim> normal;
  Real distance;
};

/// Frame in space: one tangent t_1 is carried along; t_2 = n × t_1.
template <typename Real>
struct ContactFrame<3, Real>
{
  std::array<Real, 3> normal;
  Real distance;
  std::array<Real, 3> tangent; ///< t_1
};

/// Motion of a contact over a step.
template <int dim, typename Real>
struct ContactMotion
{
  ContactFrame<dim, Real> frame;               ///< at the end
  std::array<Real, dim - 1> slip;              ///< ΔU_s at the contact point, along t, or t_1 and t_2 [m]
  std::array<Real, n_rotations<dim>> rotation; ///< Δθ of grain 2 against grain 1: about k, or n, t_1 and t_2 [rad]
};

/// Normal and distance of two centres; in space without a tangent yet.
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

/// ΔU_s = d̄ Δψ - a_1 Δφ_1 - a_2 Δφ_2 and Δθ = Δφ_2 - Δφ_1, in two dimensions. Exact for finite turns: a rigid rotation
/// of the pair gives zero, since a_1 + a_2 = d̄ in the mean configuration.
template <typename Real>
ContactMotion<2, Real> contact_motion(const ContactFrame<2, Real>& before, const std::array<Real, 2>& centre_1,
                                      const std::array<Real, 2>& centre_2, const Real& half_radius_difference,
                                      const std::array<Real, 1>& turn_1, const std::array<Real, 1>& turn_2)
{
  const auto now = contact_frame<2, Real>(centre_1, centre_2);
  const Real sine = before.normal[0] * now.normal[1] - before.normal[1] * now.normal[0];
  const Real cosine = before.normal[0] * now.normal[0] + before.normal[1] * now.normal[1];
  const Real mean_distance = 0.5 * (before.distance + now.distance);
  const auto a = arms(mean_distance, half_radius_difference);
  return {now,
          {mean_distance * angle_turned(sine, cosine) - a.one * turn_1[0] - a.two * turn_2[0]},
          {turn_2[0] - turn_1[0]}};
}

/// Vectors in space; [3].
namespace space
{
template <typename Real>
using Triple = std::array<Real, 3>;

template <typename Real>
Real dot(const Triple<Real>& a, const Triple<Real>& b)
{
  return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

template <typename Real>
Triple<Real> cross(const Triple<Real>& a, const Triple<Real>& b)
{
  return {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
}

/// A unit vector across n, the same for the same n.
inline Triple<double> tangent_to(const Triple<double>& n)
{
  int least = 0;
  for (int c = 1; c < 3; ++c)
    if (std::abs(n[c]) < std::abs(n[least]))
      least = c;
  Triple<double> tangent{-n[least] * n[0], -n[least] * n[1], -n[least] * n[2]};
  tangent[least] += 1.0;
  const double inverse = 1.0 / std::sqrt(dot(tangent, tangent));
  for (double& component : tangent)
    component *= inverse;
  return tangent;
}

/// Coefficients of Rodrigues' formula: R v = v + s φ × v + q φ × (φ × v).
template <typename Real>
struct Turn
{
  Real sine_share;    ///< s = sin|φ|/|φ|
  Real versine_share; ///< q = (1 - cos|φ|)/|φ|²
};

/// Up to this |φ|² the series below are exact to round-off.
inline constexpr double small_turn_squared = 1e-4;

template <typename Real>
Turn<Real> series_turn(const Real& x)
{
  Turn<Real> turn;
  turn.sine_share = 1.0 - x * (1.0 / 6.0 - x * (1.0 / 120.0 - x * (1.0 / 5040.0)));
  turn.versine_share = 0.5 - x * (1.0 / 24.0 - x * (1.0 / 720.0 - x * (1.0 / 40320.0)));
  return turn;
}

/// squared: |φ|².
inline Turn<double> make_turn(const double squared)
{
  if (squared < small_turn_squared)
    return series_turn(squared);
  const double angle = std::sqrt(squared);
  return {std::sin(angle) / angle, (1.0 - std::cos(angle)) / squared};
}

inline Turn<simd::Pack> make_turn(const simd::Pack& squared)
{
  auto turn = series_turn(squared);
  if (simd::any(!(squared < small_turn_squared)))
    {
      turn.sine_share = simd::Pack([&](const auto i) { return make_turn(double(squared[i])).sine_share; });
      turn.versine_share = simd::Pack([&](const auto i) { return make_turn(double(squared[i])).versine_share; });
    }
  return turn;
}

/// The change of v is as small as the turn. Terms that stay the same from step to step, such as what v has along φ, would be rounded
/// the same way each time, and the vector would drift.
template <typename Real>
Triple<Real> turned(const Triple<Real>& v, const Triple<Real>& angle, const Turn<Real>& turn)
{
  const auto across = cross(angle, v);
  const auto back = cross(angle, across);
  Triple<Real> result;
  for (int c = 0; c < 3; ++c)
    result[c] = v[c] + (turn.sine_share * across[c] + turn.versine_share * back[c]);
  return result;
}

/// asin(s)/s, from s² and the cosine: arc over chord.
inline double arc_share(const double sine_squared, const double cosine)
{
  if (sine_squared < small_turn_squared && cosine > 0.0)
    return 1.0 + sine_squared * (1.0 / 6.0 + sine_squared * (3.0 / 40.0 + sine_squared * (15.0 / 336.0)));
  const double sine = std::sqrt(sine_squared);
  return std::atan2(sine, cosine) / sine;
}

inline simd::Pack arc_share(const simd::Pack& sine_squared, const simd::Pack& cosine)
{
  simd::Pack share = 1.0 + sine_squared * (1.0 / 6.0 + sine_squared * (3.0 / 40.0 + sine_squared * (15.0 / 336.0)));
  if (simd::any(!(sine_squared < small_turn_squared && cosine > 0.0)))
    share = simd::Pack([&](const auto i) { return arc_share(double(sine_squared[i]), double(cosine[i])); });
  return share;
}
} // namespace space

/// The same in three dimensions. The old frame is carried by the mean rotation of both grains, then by the least turn
/// that takes its normal to the new one. With δ that turn (n' × δ towards the new normal),
///   ΔU_s = d̄ δ + ½(R1 - R2) Δθ × n,
/// which is d̄ Δψ - a_1 Δφ_1 - a_2 Δφ_2 of the plane. A rigid rotation of the pair, however large, gives zero exactly.
template <typename Real>
ContactMotion<3, Real> contact_motion(const ContactFrame<3, Real>& before, const std::array<Real, 3>& centre_1,
                                      const std::array<Real, 3>& centre_2, const Real& half_radius_difference,
                                      const std::array<Real, 3>& turn_1, const std::array<Real, 3>& turn_2)
{
  using namespace space;
  ContactMotion<3, Real> motion{contact_frame<3, Real>(centre_1, centre_2), {}, {}};
  const Triple<Real>& n = motion.frame.normal;
  Triple<Real> mean_turn, difference;
  for (int c = 0; c < 3; ++c)
    {
      mean_turn[c] = 0.5 * (turn_1[c] + turn_2[c]);
      difference[c] = turn_2[c] - turn_1[c];
    }
  const auto turn = make_turn(dot(mean_turn, mean_turn));
  const auto carried_normal = turned(before.normal, mean_turn, turn);
  const auto carried_tangent = turned(before.tangent, mean_turn, turn);

  const Real sine_1 = dot(n, carried_tangent);
  const Real sine_2 = dot(n, cross(carried_normal, carried_tangent));
  const Real cosine = dot(n, carried_normal);
  const Real arc =
    0.5 * (before.distance + motion.frame.distance) * arc_share(Real(sine_1 * sine_1 + sine_2 * sine_2), cosine);

  // The least turn takes t' to t' - (n·t')/(1 + n·n') (n + n'); what round-off leaves along n would look like slip.
  Triple<Real>& t = motion.frame.tangent;
  const Real share = sine_1 / (1.0 + cosine);
  for (int c = 0; c < 3; ++c)
    t[c] = carried_tangent[c] - share * (n[c] + carried_normal[c]);
  const Real along = dot(t, n);
  const Real lengthen = 1.5 - 0.5 * dot(t, t);
  for (int c = 0; c < 3; ++c)
    t[c] = (t[c] - along * n[c]) * lengthen;

  // Rotations are taken along the mean of the old axes and the new, so that forces before and after do the work they
  // store.
  const auto mean = [&](const Triple<Real>& old_axis, const Triple<Real>& new_axis) {
    Real sum(0.0);
    for (int c = 0; c < 3; ++c)
      sum += difference[c] * (old_axis[c] + new_axis[c]);
    return 0.5 * sum;
  };
  motion.rotation = {mean(before.normal, n), mean(before.tangent, t),
                     mean(cross(before.normal, before.tangent), cross(n, t))};
  motion.slip = {arc * sine_1 + half_radius_difference * motion.rotation[2],
                 arc * sine_2 - half_radius_difference * motion.rotation[1]};
  return motion;
}

/// Force on grain 2 and the couples on both grains.
template <int dim, typename Real>
struct ContactForce
{
  std::array<Real, dim> force;                 ///< on grain 2, its opposite on grain 1 [N]
  std::array<Real, n_rotations<dim>> couple_1; ///< [N m]
  std::array<Real, n_rotations<dim>> couple_2; ///< [N m]
};

/// Brings normal force (compression positive), shear force and couple at the contact point to both centres.
template <typename Real>
ContactForce<2, Real> contact_force(const ContactFrame<2, Real>& frame, const Real& half_radius_difference,
                                    const Real& normal_force, const std::array<Real, 1>& shear_force,
                                    const std::array<Real, 1>& moment)
{
  const auto& n = frame.normal;
  const auto a = arms(frame.distance, half_radius_difference);
  return {{normal_force * n[0] - shear_force[0] * n[1], normal_force * n[1] + shear_force[0] * n[0]},
          {-moment[0] - a.one * shear_force[0]},
          {moment[0] - a.two * shear_force[0]}};
}

/// The same in three dimensions; moment about n, t_1 and t_2. n × F_s = F_1 t_2 - F_2 t_1.
template <typename Real>
ContactForce<3, Real> contact_force(const ContactFrame<3, Real>& frame, const Real& half_radius_difference,
                                    const Real& normal_force, const std::array<Real, 2>& shear_force,
                                    const std::array<Real, 3>& moment)
{
  const auto& n = frame.normal;
  const auto& t_1 = frame.tangent;
  const auto t_2 = space::cross(n, t_1);
  const auto a = arms(frame.distance, half_radius_difference);
  const auto in_space = [&](const Real& along_n, const Real& along_1, const Real& along_2) {
    std::array<Real, 3> v;
    for (int c = 0; c < 3; ++c)
      v[c] = along_n * n[c] + along_1 * t_1[c] + along_2 * t_2[c];
    return v;
  };
  return {in_space(normal_force, shear_force[0], shear_force[1]),
          in_space(-moment[0], a.one * shear_force[1] - moment[1], -a.one * shear_force[0] - moment[2]),
          in_space(moment[0], moment[1] + a.two * shear_force[1], moment[2] - a.two * shear_force[0])};
}

/// A contact plane that is carried by its grains: across the line between their centres. How the faces of a joint law
/// move that derives from it.
template <int dim>
struct CarriedPlane
{
  template <typename Real>
  static ContactMotion<dim, Real> motion(const ContactFrame<dim, Real>& before, const std::array<Real, dim>& centre_1,
                                         const std::array<Real, dim>& centre_2, const Real& half_radius_difference,
                                         const std::array<Real, n_rotations<dim>>& turn_1,
                                         const std::array<Real, n_rotations<dim>>& turn_2)
  {
    return contact_motion(before, centre_1, centre_2, half_radius_difference, turn_1, turn_2);
  }

  template <typename Real>
  static ContactForce<dim, Real> force(const ContactFrame<dim, Real>& frame, const Real& half_radius_difference,
                                       const Real& normal_force, const std::array<Real, dim - 1>& shear_force,
                                       const std::array<Real, n_rotations<dim>>& moment)
  {
    return contact_force(frame, half_radius_difference, normal_force, shear_force, moment);
  }
};
} // namespace feldspar

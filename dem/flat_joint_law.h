#pragma once

#include "dem/simd.h"

#include <array>

/// The flat-joint law: how one segment of a joint's face answers a motion of its two grains.
///
/// Force: normal stress by gap, shear stress by accumulated slip, bending by the gap's slope over the face.
/// Breaking: tension beyond the bond tensile strength, or shear beyond cohesion + friction; for good.
/// After breaking the face stays: it closes, opens, slides with friction and resists rotation.
///
/// Units SI. Signs: stress and gap positive in tension (open), forces and couples on grain 2, n from grain 1 to 2,
/// t = n turned by +90°, couples along n × t. Sources: docs/theory.md §1; (n) is equation n of the flat-joint paper
/// cited there. Functions are pure and free of loops, storage and files; Real is double or a pack of doubles.
namespace feldspar::flat_joint
{
using simd::absolute;
using simd::larger;
using simd::select;
using simd::smaller;

/// The face shared by the segments of one joint in two dimensions.
template <typename Real>
struct Face
{
  Real normal_stiffness; ///< k_n [Pa/m]
  Real shear_stiffness;  ///< k_s [Pa/m]
  Real segment_length;   ///< ℓ = 2R̄/N [m] (8)
  double thickness;      ///< t [m]
  double friction;       ///< μ [-]

  Real segment_area() const { return segment_length * thickness; }
};

/// Strength of one segment's bond.
template <typename Real>
struct Bond
{
  Real tensile_strength; ///< σ_b [Pa]
  Real cohesion;         ///< c_b [Pa]
  double friction_slope; ///< tan φ_b [-]
};

/// What a segment remembers; dim - 1 shear components.
template <int dim, typename Real>
struct SegmentState
{
  std::array<Real, dim - 1> shear_stress; ///< τ [Pa]
  decltype(Real() < Real()) bonded;
};

/// The motion of a segment over one step.
template <int dim, typename Real>
struct SegmentMotion
{
  Real gap_before;                           ///< centroid gap at the start [m]
  Real gap;                                  ///< centroid gap at the end [m]
  Real slope;                                ///< θ at the end: the gap falls by θ per length along t [rad]
  std::array<Real, dim - 1> shear_increment; ///< ΔU_s at the centroid [m]
};

/// Normal answer of a segment to its gap.
template <typename Real>
struct NormalResponse
{
  Real force;       ///< F_n [N], compression positive
  Real moment;      ///< M_i [N m] about the segment's centroid
  Real mean_stress; ///< σ̂ = -F_n/A [Pa]
  Real energy;      ///< stored by the normal stress [J]
};

/// New state, answer and event of one update.
template <int dim, typename Real>
struct SegmentUpdate
{
  SegmentState<dim, Real> state;
  NormalResponse<Real> normal;
  decltype(Real() < Real()) tension_break;
  decltype(Real() < Real()) shear_break;
  Real slip_energy;     ///< dissipated by friction in this step [J]
  Real released_energy; ///< stored energy lost at a break in this step [J]
};

/// Distance of segment i = 0 … N-1 from the middle of the face, along t [m]; (8), counted from 0.
template <typename Real>
Real segment_offset(const unsigned int i, const unsigned int n_segments, const Real& half_length)
{
  return half_length * ((double(n_segments) - 1.0 - 2.0 * i) / n_segments);
}

/// g(ρ) = g_0 + U_n - θρ [m], positive open; (6) with ξ = R̄ - ρ.
template <typename Real>
Real gap_at(const Real& opening, const Real& slope, const Real& offset)
{
  return opening - slope * offset;
}

/// Exact integrals of the piecewise linear stress σ = k_n g, which acts where bonded or closed; (7), (10), (11).
template <typename Real, typename Mask>
NormalResponse<Real> normal_response(const Face<Real>& face, const Real& gap, const Real& slope, const Mask& bonded)
{
  const Real k_n = face.normal_stiffness;
  const Real l = face.segment_length;
  const double t = face.thickness;
  const Real rise = absolute(slope) * l; // g_max - g_min over the segment
  const Real g_min = gap - 0.5 * rise;
  const Real g_max = gap + 0.5 * rise;
  const Mask whole = bonded || g_max <= 0.0;
  const Mask open = !whole && g_min >= 0.0;

  const Real h = select(whole || open, l, l * (-g_min / (g_max - g_min))); // closed length
  const Real partial_force = -0.5 * k_n * t * h * g_min;
  const Real partial_arm = select(slope < 0.0, -1.0, Real(1.0)) * (0.5 * l - h / 3.0);

  NormalResponse<Real> response;
  response.force = select(whole, -k_n * (l * t) * gap, select(open, Real(0.0), partial_force));
  response.moment =
    select(whole, -k_n * t * slope * (l * l * l) / 12.0, select(open, Real(0.0), -partial_force * partial_arm));
  response.mean_stress = -response.force / face.segment_area();
  response.energy =
    0.5 * k_n * t *
    select(whole, l * gap * gap + slope * slope * (l * l * l) / 12.0, select(open, Real(0.0), h * g_min * g_min / 3.0));
  return response;
}

/// Share of a step, 0 … 1, in which the centroid gap is negative when it moves linearly; only then does an unbonded
/// segment gather shear.
template <typename Real>
Real closed_share(const Real& gap_before, const Real& gap)
{
  const auto was_closed = gap_before < 0.0;
  const auto is_closed = gap < 0.0;
  const Real change = select(was_closed == is_closed, Real(1.0), gap - gap_before);
  return select(was_closed, select(is_closed, Real(1.0), -gap_before / change),
                select(is_closed, gap / change, Real(0.0)));
}

template <typename Real>
Real magnitude(const std::array<Real, 1>& shear)
{
  return absolute(shear[0]);
}

template <typename Real>
Real magnitude(const std::array<Real, 2>& shear)
{
  return simd::square_root(shear[0] * shear[0] + shear[1] * shear[1]);
}

/// One update of one segment, in this order: tension, trial shear, friction or shear strength, answer.
template <int dim, typename Real>
SegmentUpdate<dim, Real> update(const Face<Real>& face, const Bond<Real>& bond, const SegmentState<dim, Real>& old,
                                const SegmentMotion<dim, Real>& motion)
{
  const Real k_s = face.shear_stiffness;
  const Real area = face.segment_area();
  SegmentUpdate<dim, Real> result;

  // Tension: a bonded segment beyond σ_b breaks.
  const Real bonded_stress = face.normal_stiffness * motion.gap; // (10)
  result.tension_break = old.bonded && bonded_stress > bond.tensile_strength;

  // Trial shear (13): the whole increment while bonded, else its closed share.
  const Real share = select(old.bonded, Real(1.0), closed_share(motion.gap_before, motion.gap));
  std::array<Real, dim - 1> trial;
  for (int c = 0; c < dim - 1; ++c)
    trial[c] = old.shear_stress[c] - k_s * share * motion.shear_increment[c];
  const Real tau = magnitude(trial);

  // Shear strength of the bond (15).
  const Real tau_c = larger(Real(0.0), bond.cohesion - bonded_stress * bond.friction_slope);
  result.shear_break = old.bonded && !result.tension_break && tau > tau_c;

  const auto broke = result.tension_break || result.shear_break;
  result.state.bonded = old.bonded && !broke;
  result.normal = normal_response(face, motion.gap, motion.slope, result.state.bonded);

  // Friction (14) limits an unbonded segment; a break leaves no shear.
  const Real limit = face.friction * larger(Real(0.0), -result.normal.mean_stress);
  const auto slides = !old.bonded && tau > limit;
  const Real kept = select(broke, Real(0.0), select(slides, limit / select(slides, tau, Real(1.0)), Real(1.0)));
  for (int c = 0; c < dim - 1; ++c)
    result.state.shear_stress[c] = kept * trial[c];

  // Slip over the step, by the same trapezoid as the work of the contact force; what a break lets go at once.
  Real slip_work(0.0);
  Real shear_squared(0.0);
  for (int c = 0; c < dim - 1; ++c)
    {
      slip_work +=
        0.5 * (old.shear_stress[c] + result.state.shear_stress[c]) * (trial[c] - result.state.shear_stress[c]);
      const Real shear = select(result.tension_break, old.shear_stress[c], trial[c]);
      shear_squared += shear * shear;
    }
  result.slip_energy = select(slides, slip_work * area / k_s, Real(0.0));
  result.released_energy = Real(0.0);
  if (simd::any(broke))
    {
      const Real stored = normal_response(face, motion.gap, motion.slope, old.bonded).energy;
      result.released_energy =
        select(broke, stored - result.normal.energy + 0.5 * shear_squared * area / k_s, Real(0.0));
    }
  return result;
}
} // namespace feldspar::flat_joint

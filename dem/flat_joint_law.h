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
  Real force;  ///< F_n [N], compression positive
  Real moment; ///< M_i [N m] about the segment's centroid
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

/// The closed part of an unbonded segment, whose gap runs linearly from g_min to g_max.
template <typename Real>
struct ClosedPart
{
  Real g_min;
  Real length; ///< h [m]; 0 where the segment is open, ℓ where it is closed
};

template <typename Real>
ClosedPart<Real> closed_part(const Face<Real>& face, const Real& gap, const Real& slope)
{
  const Real rise = absolute(slope) * face.segment_length; // g_max - g_min
  const Real g_min = gap - 0.5 * rise;
  const Real share = -g_min / select(rise > 0.0, rise, Real(1.0));
  const Real part = select(g_min >= 0.0, Real(0.0), select(gap + 0.5 * rise <= 0.0, Real(1.0), share));
  return {g_min, part * face.segment_length};
}

/// Exact integrals of the piecewise linear stress σ = k_n g, which acts where bonded or closed; (7), (10), (11).
template <typename Real, typename Mask>
NormalResponse<Real> normal_response(const Face<Real>& face, const Real& gap, const Real& slope, const Mask& bonded)
{
  const Real k_n = face.normal_stiffness;
  const Real l = face.segment_length;
  const double t = face.thickness;
  NormalResponse<Real> response{-k_n * (l * t) * gap, -k_n * (l * l * l * (t / 12.0)) * slope};
  if (simd::all(bonded))
    return response;

  const auto [g_min, h] = closed_part(face, gap, slope);
  const auto partly = !bonded && h < l;
  const Real force = -0.5 * k_n * t * h * g_min;
  const Real arm = select(slope < 0.0, Real(-1.0), Real(1.0)) * (0.5 * l - h * (1.0 / 3.0));
  response.force = select(partly, force, response.force);
  response.moment = select(partly, -force * arm, response.moment);
  return response;
}

/// What the normal stress stores [J].
template <typename Real, typename Mask>
Real normal_energy(const Face<Real>& face, const Real& gap, const Real& slope, const Mask& bonded)
{
  const Real l = face.segment_length;
  const auto [g_min, h] = closed_part(face, gap, slope);
  const Real whole = l * gap * gap + slope * slope * (l * l * l * (1.0 / 12.0));
  const Real part = h * g_min * g_min * (1.0 / 3.0);
  return 0.5 * face.normal_stiffness * face.thickness * select(!bonded && h < l, part, whole);
}

/// σ̂ = -F_n/A [Pa], tension positive.
template <typename Real>
Real mean_stress(const Face<Real>& face, const NormalResponse<Real>& normal)
{
  return -normal.force / face.segment_area();
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
  const auto unbonded = !old.bonded;
  const bool some_unbonded = simd::any(unbonded);
  SegmentUpdate<dim, Real> result;
  result.slip_energy = Real(0.0);
  result.released_energy = Real(0.0);

  // Tension: a bonded segment beyond σ_b breaks.
  const Real bonded_stress = face.normal_stiffness * motion.gap; // (10)
  result.tension_break = old.bonded && bonded_stress > bond.tensile_strength;

  // Trial shear (13): the whole increment while bonded, else its closed share.
  Real stiffness = k_s;
  if (some_unbonded)
    stiffness = select(unbonded, k_s * closed_share(motion.gap_before, motion.gap), k_s);
  auto& tau = result.state.shear_stress;
  for (int c = 0; c < dim - 1; ++c)
    tau[c] = old.shear_stress[c] - stiffness * motion.shear_increment[c];

  // Shear strength of the bond (15).
  const Real tau_c = larger(Real(0.0), bond.cohesion - bonded_stress * bond.friction_slope);
  result.shear_break = old.bonded && !result.tension_break && magnitude(tau) > tau_c;

  const auto broke = result.tension_break || result.shear_break;
  result.state.bonded = old.bonded && !broke;
  result.normal = normal_response(face, motion.gap, motion.slope, result.state.bonded);

  // Friction (14) limits an unbonded segment.
  if (some_unbonded)
    {
      const Real limit = face.friction * larger(Real(0.0), -mean_stress(face, result.normal));
      const Real size = magnitude(tau);
      const auto slides = unbonded && size > limit;
      const Real kept = select(slides, limit / select(slides, size, Real(1.0)), Real(1.0));
      // Slip under the mean of the stresses before and after: the trapezoid by which the contact does its work.
      Real slip_work(0.0);
      for (int c = 0; c < dim - 1; ++c)
        {
          const Real trial = tau[c];
          tau[c] = kept * trial;
          slip_work += 0.5 * (old.shear_stress[c] + tau[c]) * (trial - tau[c]);
        }
      result.slip_energy = select(slides, slip_work * face.segment_area() / k_s, Real(0.0));
    }

  // A break leaves no shear, and lets go at once what it stored.
  if (simd::any(broke))
    {
      Real shear_squared(0.0);
      for (int c = 0; c < dim - 1; ++c)
        {
          shear_squared += old.shear_stress[c] * tau[c];
          tau[c] = select(broke, Real(0.0), tau[c]);
        }
      const Real stored =
        normal_energy(face, motion.gap, motion.slope, old.bonded) + 0.5 * shear_squared * face.segment_area() / k_s;
      result.released_energy =
        select(broke, stored - normal_energy(face, motion.gap, motion.slope, result.state.bonded), Real(0.0));
    }
  return result;
}
} // namespace feldspar::flat_joint

#pragma once

#include "base/simd.h"
#include "dem/laws/bond_strength.h"

#include <array>

/// The flat-joint law: how one segment of a joint's face responds to a motion of its two grains. In three dimensions a
/// segment is an element of a disk, its stress that at its centroid; all else is the same.
///
/// Force: normal stress by gap, shear stress by accumulated slip, bending by the gap's slope over the segment.
/// Breaking: tension beyond the bond tensile strength, or shear beyond cohesion + friction; for good.
/// After breaking the face stays: it closes, opens, slides with friction and resists rotation.
///
/// Units SI. Signs: stress and gap positive in tension (open), forces and couples on grain 2, n from grain 1 to 2,
/// t = n turned by +90°, couples along n × t. Sources: docs/theory.md §1; (n) is equation n of the flat-joint paper
/// cited there. Functions are pure and free of loops, storage and files; Real is double or a pack of doubles.
namespace feldspar::flat_joint
{
using feldspar::Bond;
using simd::absolute;
using simd::larger;
using simd::magnitude;
using simd::select;

/// A segment of a face in two dimensions.
template <int dim, typename Real>
struct Segment
{
  Real normal_stiffness; ///< k_n [Pa/m]
  Real shear_stiffness;  ///< k_s [Pa/m]
  Real length;           ///< ℓ [m]
  double thickness;      ///< t [m]
  Real friction;         ///< μ [-]

  Real area() const { return length * thickness; }
};

/// An element of a face in three dimensions.
template <typename Real>
struct Segment<3, Real>
{
  Real normal_stiffness; ///< k_n [Pa/m]
  Real shear_stiffness;  ///< k_s [Pa/m]
  Real element_area;     ///< A_e [m²]
  Real friction;         ///< μ [-]

  Real area() const { return element_area; }
};

/// The state of a segment; dim - 1 shear components.
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
  Real slope;                                ///< θ at the end: the gap falls by θ per length along t [rad]; 2D only
  std::array<Real, dim - 1> shear_increment; ///< ΔU_s at the centroid [m]
};

/// Normal response of a segment to its gap.
template <typename Real>
struct NormalResponse
{
  Real force;  ///< F_n [N], compression positive
  Real moment; ///< M_i [N m] about the segment's centroid
};

/// New state, response and event of one update.
template <int dim, typename Real>
struct SegmentUpdate
{
  SegmentState<dim, Real> state;
  NormalResponse<Real> normal;
  decltype(Real() < Real()) tension_break;
  decltype(Real() < Real()) shear_break;
  Real slip_energy;     ///< of shear that the shear stress did not follow, in this step [J]
  Real released_energy; ///< stored energy lost at a break in this step [J]
};

/// g(ρ) = g_0 + U_n - θρ [m], positive open; (6) with ξ = R̄ - ρ.
template <typename Real>
Real gap_at(const Real& opening, const std::array<Real, 1>& rotation, const std::array<Real, 1>& offset)
{
  return opening - rotation[0] * offset[0];
}

/// g(r) = g_0 + U_n + n·(θ × r) [m]; θ about n, t_1 and t_2, r along t_1 and t_2.
template <typename Real>
Real gap_at(const Real& opening, const std::array<Real, 3>& rotation, const std::array<Real, 2>& offset)
{
  return opening + (rotation[1] * offset[1] - rotation[2] * offset[0]);
}

/// Slip at a segment from that at the contact point, ΔU_s; the same all over a face that does not twist.
template <typename Real>
std::array<Real, 1> slip_at(const std::array<Real, 1>& slip, const Real& /*twist*/,
                            const std::array<Real, 1>& /*offset*/)
{
  return slip;
}

/// ΔU_s + Δθ_n n × r in three dimensions.
template <typename Real>
std::array<Real, 2> slip_at(const std::array<Real, 2>& slip, const Real& twist, const std::array<Real, 2>& offset)
{
  return {slip[0] - twist * offset[1], slip[1] + twist * offset[0]};
}

/// The closed part of an unbonded segment, whose gap runs linearly from g_min to g_max.
template <typename Real>
struct ClosedPart
{
  Real g_min;
  Real length; ///< h [m]; 0 where the segment is open, ℓ where it is closed
};

template <typename Real>
ClosedPart<Real> closed_part(const Segment<2, Real>& segment, const Real& gap, const Real& slope)
{
  const Real rise = absolute(slope) * segment.length; // g_max - g_min
  const Real g_min = gap - 0.5 * rise;
  const Real share = -g_min / select(rise > 0.0, rise, Real(1.0));
  const Real part = select(g_min >= 0.0, Real(0.0), select(gap + 0.5 * rise <= 0.0, Real(1.0), share));
  return {g_min, part * segment.length};
}

/// Exact integrals of the piecewise linear stress σ = k_n g, which acts where bonded or closed; (7), (10), (11).
template <typename Real, typename Mask>
NormalResponse<Real> normal_response(const Segment<2, Real>& segment, const Real& gap, const Real& slope,
                                     const Mask& bonded)
{
  const Real k_n = segment.normal_stiffness;
  const Real l = segment.length;
  const double t = segment.thickness;
  NormalResponse<Real> response{-k_n * (l * t) * gap, -k_n * (l * l * l * (t / 12.0)) * slope};
  if (simd::all(bonded))
    return response;

  const auto [g_min, h] = closed_part(segment, gap, slope);
  const auto partly = !bonded && h < l;
  const Real force = -0.5 * k_n * t * h * g_min;
  const Real arm = select(slope < 0.0, Real(-1.0), Real(1.0)) * (0.5 * l - h * (1.0 / 3.0));
  response.force = select(partly, force, response.force);
  response.moment = select(partly, -force * arm, response.moment);
  return response;
}

/// σ = k_n g at the centroid over the whole element, without a moment of its own: bending and twist are lumped.
template <typename Real, typename Mask>
NormalResponse<Real> normal_response(const Segment<3, Real>& segment, const Real& gap, const Real& /*slope*/,
                                     const Mask& bonded)
{
  const Real force = -segment.normal_stiffness * segment.area() * gap;
  return {select(!bonded && gap >= 0.0, Real(0.0), force), Real(0.0)};
}

/// The energy that the normal stress stores [J].
template <typename Real, typename Mask>
Real normal_energy(const Segment<2, Real>& segment, const Real& gap, const Real& slope, const Mask& bonded)
{
  const Real l = segment.length;
  const auto [g_min, h] = closed_part(segment, gap, slope);
  const Real whole = l * gap * gap + slope * slope * (l * l * l * (1.0 / 12.0));
  const Real part = h * g_min * g_min * (1.0 / 3.0);
  return 0.5 * segment.normal_stiffness * segment.thickness * select(!bonded && h < l, part, whole);
}

template <typename Real, typename Mask>
Real normal_energy(const Segment<3, Real>& segment, const Real& gap, const Real& /*slope*/, const Mask& bonded)
{
  return select(!bonded && gap >= 0.0, Real(0.0), 0.5 * segment.normal_stiffness * segment.area() * gap * gap);
}

/// σ̂ = -F_n/A [Pa], tension positive.
template <int dim, typename Real>
Real mean_stress(const Segment<dim, Real>& segment, const NormalResponse<Real>& normal)
{
  return -normal.force / segment.area();
}

/// Share of a step, 0 … 1, in which the centroid gap is negative when it moves linearly; only then does an unbonded
/// segment gather shear.
template <typename Real>
Real closed_share(const Real& gap_before, const Real& gap)
{
  const auto was_closed = gap_before < 0.0;
  const auto is_closed = gap < 0.0;
  if (!simd::any(was_closed != is_closed)) // spares the divisions
    return select(is_closed, Real(1.0), Real(0.0));
  const Real change = select(was_closed == is_closed, Real(1.0), gap - gap_before);
  return select(was_closed, select(is_closed, Real(1.0), -gap_before / change),
                select(is_closed, gap / change, Real(0.0)));
}

/// One update of one segment, in this order: tension, trial shear, friction or shear strength, response.
template <int dim, typename Real>
SegmentUpdate<dim, Real> update(const Segment<dim, Real>& segment, const Bond<Real>& bond,
                                const SegmentState<dim, Real>& old, const SegmentMotion<dim, Real>& motion)
{
  const Real k_s = segment.shear_stiffness;
  const auto unbonded = !old.bonded;
  const bool some_unbonded = simd::any(unbonded);
  SegmentUpdate<dim, Real> result;
  result.slip_energy = Real(0.0);
  result.released_energy = Real(0.0);

  // Tension: a bonded segment beyond σ_b breaks.
  const Real bonded_stress = segment.normal_stiffness * motion.gap; // (10)
  result.tension_break = old.bonded && bonded_stress > bond.tensile_strength;

  // Trial shear (13): the whole increment while bonded, else its closed share.
  Real stiffness = k_s;
  if (some_unbonded)
    stiffness = select(unbonded, k_s * closed_share(motion.gap_before, motion.gap), k_s);
  auto& tau = result.state.shear_stress;
  for (int c = 0; c < dim - 1; ++c)
    tau[c] = old.shear_stress[c] - stiffness * motion.shear_increment[c];

  // Shear strength of the bond (15).
  const Real tau_c = shear_strength(bond, bonded_stress);
  result.shear_break = old.bonded && !result.tension_break && magnitude(tau) > tau_c;

  const auto broke = result.tension_break || result.shear_break;
  result.state.bonded = old.bonded && !broke;
  result.normal = normal_response(segment, motion.gap, motion.slope, result.state.bonded);

  // Friction (14) limits an unbonded segment.
  if (some_unbonded)
    {
      const Real limit = segment.friction * larger(Real(0.0), -mean_stress(segment, result.normal));
      const Real size = magnitude(tau);
      const auto slides = unbonded && size > limit;
      Real kept(1.0);
      if (simd::any(slides))
        kept = select(slides, limit / select(slides, size, Real(1.0)), kept);
      // Slip is what shear the stress did not follow, by friction or because the middle is open while an edge presses;
      // under the mean of the stresses before and after, the trapezoid by which the contact does its work.
      Real slip_work(0.0);
      for (int c = 0; c < dim - 1; ++c)
        {
          tau[c] = kept * tau[c];
          slip_work +=
            0.5 * (old.shear_stress[c] + tau[c]) * (old.shear_stress[c] - k_s * motion.shear_increment[c] - tau[c]);
        }
      result.slip_energy = select(unbonded, slip_work * segment.area() / k_s, Real(0.0));
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
        normal_energy(segment, motion.gap, motion.slope, old.bonded) + 0.5 * shear_squared * segment.area() / k_s;
      result.released_energy =
        select(broke, stored - normal_energy(segment, motion.gap, motion.slope, result.state.bonded), Real(0.0));
    }
  return result;
}
} // namespace feldspar::flat_joint

#pragma once

#include "base/simd.h"
#include "dem/laws/flat_joint_law.h"

#include <algorithm>
#include <array>
#include <limits>

/// A segment of a flat joint whose bond does not lose its stress at once: beyond its strength it falls along a straight line
/// over the softening opening, in tension and in shear. What remains of the bond is one number between both, so that what
/// one takes is lost to the other. Without a bond the segment is that of the flat joint. docs/theory.md §1.10, (s.n) below;
/// signs and notation as in flat_joint_law.h.
namespace feldspar::softening
{
using simd::larger;
using simd::magnitude;
using simd::select;
using simd::smaller;

/// The state of a segment.
template <int dim, typename Real>
struct State
{
  std::array<Real, dim - 1> shear_stress; ///< τ [Pa]
  decltype(Real() < Real()) bonded;
  /// While a bond holds: D, the lost share of its stiffness in tension; the part of d that shear has taken; what it has
  /// dissipated so far [J].
  std::array<Real, 3> more;
};

/// New state, response and event of one update.
template <int dim, typename Real>
struct Update
{
  State<dim, Real> state;
  flat_joint::NormalResponse<Real> normal;
  decltype(Real() < Real()) tension_break;
  decltype(Real() < Real()) shear_break;
  Real slip_energy;     ///< of friction, in this step [J]
  Real released_energy; ///< of a break: all that the bond has dissipated [J]
};

/// Line (s.1) of a bond in tension: its stress falls from σ_b to zero while the segment opens by w.
template <typename Real>
class Softening
{
public:
  /// w [m], k_n [Pa/m], σ_b [Pa].
  Softening(const double over_opening, const Real& normal_stiffness, const Real& tensile_strength)
    : strength(larger(tensile_strength, Real(1.0))) // so that a bond without any has a line, too
    , fall(larger(normal_stiffness * over_opening, Real(std::numeric_limits<double>::min())))
  {
  }

  /// d of a bond that has borne this stress as if it were elastic; below 0 of one that has not come to its strength.
  Real at(const Real& elastic_stress) const { return smaller(Real(1.0), (elastic_stress - strength) / fall); }

  /// D of d: (s.2).
  Real damage(const Real& d) const { return 1.0 - (1.0 - d) * strength / (strength + d * fall); }
  /// d of D.
  Real softened(const Real& damage) const { return damage * strength / (strength + (1.0 - damage) * fall); }

private:
  Real strength; ///< σ_b [Pa]
  Real fall;     ///< k_n w [Pa]
};

/// Between the response with the bond and that without: (s.3).
template <typename Real>
Real between(const Real& damage, const Real& bonded, const Real& unbonded)
{
  return bonded + damage * (unbonded - bonded);
}

template <int dim, typename Real>
flat_joint::NormalResponse<Real> damaged_response(const flat_joint::Segment<dim, Real>& segment, const Real& gap,
                                                  const Real& slope, const Real& damage)
{
  using Mask = decltype(Real() < Real());
  const auto bonded = flat_joint::normal_response(segment, gap, slope, Mask(true));
  if (simd::all(damage == 0.0))
    return bonded;
  const auto unbonded = flat_joint::normal_response(segment, gap, slope, Mask(false));
  return {between(damage, bonded.force, unbonded.force), between(damage, bonded.moment, unbonded.moment)};
}

/// The energy that the normal stress stores with the bond and would not store without it [J].
template <int dim, typename Real>
Real energy_of_bond(const flat_joint::Segment<dim, Real>& segment, const Real& gap, const Real& slope)
{
  using Mask = decltype(Real() < Real());
  return flat_joint::normal_energy(segment, gap, slope, Mask(true)) -
         flat_joint::normal_energy(segment, gap, slope, Mask(false));
}

/// One update of one segment whose bond holds, in this order: tension, trial shear, shear strength, response.
template <int dim, typename Real>
Update<dim, Real> update_bonded(const flat_joint::Segment<dim, Real>& segment, const Bond<Real>& bond,
                                const double softening_opening, const State<dim, Real>& old,
                                const flat_joint::SegmentMotion<dim, Real>& motion)
{
  const Real k_n = segment.normal_stiffness;
  const Real k_s = segment.shear_stiffness;
  const Softening<Real> line(softening_opening, k_n, bond.tensile_strength);
  const Real damage_before = old.more[0];
  const Real before = line.softened(damage_before);

  // Tension: d follows the opening (s.1).
  const Real pulled = larger(before, line.at(k_n * motion.gap));

  // Trial shear (13), and the strength: friction stays, and of the bond 1 - d (s.4).
  Update<dim, Real> result;
  auto& tau = result.state.shear_stress;
  for (int c = 0; c < dim - 1; ++c)
    tau[c] = old.shear_stress[c] - k_s * motion.shear_increment[c];
  const Real left = select(motion.gap > 0.0, 1.0 - line.damage(pulled), Real(1.0));
  const Real normal_stress = left * k_n * motion.gap;
  const Real strength = shear_strength(bond, normal_stress); // (15)
  const Real residual = smaller(strength, segment.friction * larger(Real(0.0), -normal_stress));
  const Real of_bond = strength - residual;
  const Real size = magnitude(tau);
  const Real excess = size - (residual + (1.0 - pulled) * of_bond);
  const auto yields = excess > 0.0;

  // Shear beyond it: d follows the way (s.5).
  const Real fall = larger(k_s * softening_opening, Real(std::numeric_limits<double>::min()));
  const Real now = select(yields, smaller(Real(1.0), pulled + excess / fall), pulled);
  const Real by_shear = old.more[1] + (now - pulled);
  const auto broke = now >= 1.0;
  result.tension_break = broke && by_shear <= 0.5; // of the mode that has taken more of the bond
  result.shear_break = broke && !result.tension_break;
  result.state.bonded = !broke;
  const Real damage = select(now > before, line.damage(now), damage_before);
  result.normal = damaged_response(segment, motion.gap, motion.slope, damage);

  // Slip, under the mean of the stresses before and after: friction takes its part, the bond the rest.
  Real slip_energy(0.0), dissipated(0.0);
  if (simd::any(yields))
    {
      const Real limit = residual + (1.0 - now) * of_bond;
      const Real kept = select(yields, limit / select(yields, size, Real(1.0)), Real(1.0));
      for (int c = 0; c < dim - 1; ++c)
        {
          const Real trial = tau[c];
          tau[c] = kept * trial;
          dissipated += 0.5 * (old.shear_stress[c] + tau[c]) * (trial - tau[c]);
        }
      slip_energy = residual * (1.0 - kept) * size * segment.area() / k_s;
      dissipated = dissipated * segment.area() / k_s - slip_energy;
    }
  // The energy that the bond stored under tension, as far as it has gone.
  if (simd::any(damage > damage_before))
    dissipated += (damage - damage_before) * energy_of_bond(segment, motion.gap, motion.slope);

  const Real all_dissipated = old.more[2] + dissipated;
  result.slip_energy = slip_energy;
  result.released_energy = select(broke, all_dissipated, Real(0.0));
  result.state.more = {damage, by_shear, select(broke, Real(0.0), all_dissipated)};
  return result;
}

/// One update of one segment.
template <int dim, typename Real>
Update<dim, Real> update(const flat_joint::Segment<dim, Real>& segment, const Bond<Real>& bond,
                         const double softening_opening, const State<dim, Real>& old,
                         const flat_joint::SegmentMotion<dim, Real>& motion)
{
  if (simd::all(old.bonded))
    return update_bonded(segment, bond, softening_opening, old, motion);

  using Mask = decltype(Real() < Real());
  const auto unbonded = flat_joint::update<dim, Real>(segment, bond, {old.shear_stress, Mask(false)}, motion);
  Update<dim, Real> result{{unbonded.state.shear_stress, Mask(false), old.more},
                           unbonded.normal,
                           Mask(false),
                           Mask(false),
                           unbonded.slip_energy,
                           Real(0.0)};
  if (!simd::any(old.bonded))
    return result;

  const auto bonded = update_bonded(segment, bond, softening_opening, old, motion);
  const auto take = [&](Real& value, const Real& of_bonded) { value = select(old.bonded, of_bonded, value); };
  for (int c = 0; c < dim - 1; ++c)
    take(result.state.shear_stress[c], bonded.state.shear_stress[c]);
  for (std::size_t k = 0; k < result.state.more.size(); ++k)
    take(result.state.more[k], bonded.state.more[k]);
  result.state.bonded = old.bonded && bonded.state.bonded;
  take(result.normal.force, bonded.normal.force);
  take(result.normal.moment, bonded.normal.moment);
  result.tension_break = old.bonded && bonded.tension_break;
  result.shear_break = old.bonded && bonded.shear_break;
  take(result.slip_energy, bonded.slip_energy);
  take(result.released_energy, bonded.released_energy);
  return result;
}
} // namespace feldspar::softening

#pragma once

#include "base/simd.h"
#include "dem/laws/flat_joint_law.h"

#include <algorithm>
#include <array>
#include <limits>

/// A segment of a flat joint whose bond does not lose its stress at once: beyond its strength the stress falls along a
/// straight line over the softening opening, in tension and in shear. One number says for both how much of the bond
/// remains, so that softening in one weakens the other. Without a bond the segment is that of the flat joint.
/// docs/theory.md §1.10, (s.n) below; signs and notation as in flat_joint_law.h.
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

  /// d of a bond that has carried this stress as if it were elastic; below 0 of one that has not come to its strength.
  Real at(const Real& elastic_stress) const { return smaller(Real(1.0), (elastic_stress - strength) / fall); }

  /// D of d: (s.2).
  Real damage(const Real& d) const { return 1.0 - (1.0 - d) * strength / (strength + d * fall); }
  /// d of D.
  Real softened(const Real& damage) const { return damage * strength / (strength + (1.0 - damage) * fall); }

private:
  Real strength; ///< σ_b [Pa]
  Real fall;     ///< k_n w [Pa]
};

/// Value between the response with the bond and that without: (s.3).
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

/// Softening by which a bond would follow its segment.
template <typename Real>
struct Demand
{
  Real before; ///< d so far
  Real pulled; ///< d that the opening asks for (s.1), at least `before`
  Real now;    ///< d that the shear asks for beyond that (s.5)
  // Parts of the shear stress that the segment carries: (s.4).
  Real residual; ///< τ_r of friction [Pa]
  Real of_bond;  ///< τ_c - τ_r [Pa]
  Real size;     ///< |τ| as if the bond did not soften [Pa]

  Real limit(const Real& d) const { return residual + (1.0 - d) * of_bond; }
};

/// tau: as if the bond did not soften.
template <int dim, typename Real>
Demand<Real> demand(const flat_joint::Segment<dim, Real>& segment, const Bond<Real>& bond,
                    const double softening_opening, const Real& damage, const Real& gap,
                    const std::array<Real, dim - 1>& tau)
{
  const Real k_n = segment.normal_stiffness;
  const Softening<Real> line(softening_opening, k_n, bond.tensile_strength);
  Demand<Real> of;
  of.before = line.softened(damage);
  // Tension: d follows the opening (s.1).
  of.pulled = larger(of.before, line.at(k_n * gap));

  // The strength in shear: friction stays, and of the bond 1 - d (s.4).
  const Real left = select(gap > 0.0, 1.0 - line.damage(of.pulled), Real(1.0));
  const Real normal_stress = left * k_n * gap;
  const Real strength = shear_strength(bond, normal_stress); // (15)
  of.residual = smaller(strength, segment.friction * larger(Real(0.0), -normal_stress));
  of.of_bond = strength - of.residual;
  of.size = magnitude(tau);
  const Real excess = of.size - of.limit(of.pulled);

  // Shear beyond it: d follows the way (s.5).
  const Real fall = larger(segment.shear_stiffness * softening_opening, Real(std::numeric_limits<double>::min()));
  of.now = select(excess > 0.0, smaller(Real(1.0), of.pulled + excess / fall), of.pulled);
  return of;
}

/// A segment whose bond softens to d, of which shear takes `by_shear`. tau: as if it did not.
template <int dim, typename Real>
Update<dim, Real> soften(const flat_joint::Segment<dim, Real>& segment, const Bond<Real>& bond,
                         const double softening_opening, const State<dim, Real>& old,
                         const flat_joint::SegmentMotion<dim, Real>& motion, const std::array<Real, dim - 1>& tau,
                         const Demand<Real>& of, const Real& d, const Real& by_shear)
{
  const Real k_s = segment.shear_stiffness;
  const Real damage_before = old.more[0];
  const Softening<Real> line(softening_opening, segment.normal_stiffness, bond.tensile_strength);
  Update<dim, Real> result;
  const Real all_by_shear = old.more[1] + by_shear;
  const auto broke = d >= 1.0;
  result.tension_break = broke && all_by_shear <= 0.5; // of the mode that has taken more of the bond
  result.shear_break = broke && !result.tension_break;
  result.state.bonded = !broke;
  const Real damage = select(d > of.before, line.damage(d), damage_before);
  result.normal = damaged_response(segment, motion.gap, motion.slope, damage);

  // Slip, under the mean of the stresses before and after: friction takes its part, the bond the rest.
  result.state.shear_stress = tau;
  const Real limit = of.limit(d);
  const auto yields = of.size > limit;
  Real slip_energy(0.0), dissipated(0.0);
  if (simd::any(yields))
    {
      const Real kept = select(yields, limit / select(yields, of.size, Real(1.0)), Real(1.0));
      for (int c = 0; c < dim - 1; ++c)
        {
          const Real left = kept * tau[c];
          dissipated += 0.5 * (old.shear_stress[c] + left) * (tau[c] - left);
          result.state.shear_stress[c] = left;
        }
      slip_energy = of.residual * (1.0 - kept) * of.size * segment.area() / k_s;
      dissipated = dissipated * segment.area() / k_s - slip_energy;
    }
  // The energy that the bond stored under tension, as far as it has gone.
  if (simd::any(damage > damage_before))
    dissipated += (damage - damage_before) * energy_of_bond(segment, motion.gap, motion.slope);

  const Real all_dissipated = old.more[2] + dissipated;
  result.slip_energy = slip_energy;
  result.released_energy = select(broke, all_dissipated, Real(0.0));
  result.state.more = {damage, all_by_shear, select(broke, Real(0.0), all_dissipated)};
  return result;
}

/// One update of one segment whose bond holds, in this order: tension, trial shear, shear strength, response.
template <int dim, typename Real>
Update<dim, Real> update_bonded(const flat_joint::Segment<dim, Real>& segment, const Bond<Real>& bond,
                                const double softening_opening, const State<dim, Real>& old,
                                const flat_joint::SegmentMotion<dim, Real>& motion)
{
  std::array<Real, dim - 1> tau; // (13)
  for (int c = 0; c < dim - 1; ++c)
    tau[c] = old.shear_stress[c] - segment.shear_stiffness * motion.shear_increment[c];
  const auto of = demand<dim, Real>(segment, bond, softening_opening, old.more[0], motion.gap, tau);
  return soften<dim, Real>(segment, bond, softening_opening, old, motion, tau, of, of.now, of.now - of.pulled);
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

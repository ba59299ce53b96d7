#pragma once

#include "base/simd.h"

#include <algorithm>
#include <limits>

/// Strength of bonds. A bond breaks in tension beyond its tensile strength, and in shear beyond Coulomb's strength,
/// which tension lowers and pressure raises. The surface in the plane of σ and |τ| is evaluated in the forms that
/// explicit steps, equilibria and straight strain paths need. (n) is equation n of the flat-joint paper; docs/theory.md
/// §1.4.
namespace feldspar
{
/// Strength of the bond of one element of a face.
template <typename Real>
struct Bond
{
  Real tensile_strength; ///< σ_b [Pa]
  Real cohesion;         ///< c_b [Pa]
  double friction_slope; ///< tan φ_b [-]
};

/// Stress that a bond carries, or its rate along a straight path.
struct BondStress
{
  double tension; ///< largest normal stress, held against the tensile strength [Pa]
  double normal;  ///< mean normal stress, which friction goes by [Pa]
  double shear;   ///< |τ| [Pa]
};

/// τ_c = max(0, c_b - σ tan φ_b) [Pa]; (15).
template <typename Real>
Real shear_strength(const Bond<Real>& bond, const Real& normal_stress)
{
  return simd::larger(Real(0.0), bond.cohesion - normal_stress * bond.friction_slope);
}

/// |τ| + σ tan φ_b [Pa], the cohesion at which (15) would just hold: linear along a straight path.
inline double cohesion_needed(const Bond<double>& bond, const BondStress& stress)
{
  return stress.shear + bond.friction_slope * stress.normal;
}

inline bool breaks_in_tension(const Bond<double>& bond, const BondStress& stress)
{
  return stress.tension > bond.tensile_strength;
}

inline bool is_overloaded(const Bond<double>& bond, const BondStress& stress)
{
  return breaks_in_tension(bond, stress) || stress.shear > shear_strength(bond, stress.normal);
}

/// max(σ/σ_b, |τ|/τ_c); infinite without shear strength.
inline double overload_ratio(const Bond<double>& bond, const BondStress& stress)
{
  const double strength = shear_strength(bond, stress.normal);
  const double in_shear = strength > 0.0 ? stress.shear / strength : std::numeric_limits<double>::infinity();
  return std::max(stress.tension / bond.tensile_strength, in_shear);
}

/// Point at which a path whose stress grows from zero meets the surface of strength.
struct PathToBreak
{
  double factor; ///< of the rate; infinite where it never does
  bool in_tension;
};

inline PathToBreak path_to_break(const Bond<double>& bond, const BondStress& rate)
{
  PathToBreak path{std::numeric_limits<double>::infinity(), true};
  if (rate.tension > 0.0)
    path.factor = bond.tensile_strength / rate.tension;
  if (const double needed = cohesion_needed(bond, rate); needed > 0.0 && bond.cohesion / needed < path.factor)
    path = {bond.cohesion / needed, false};
  return path;
}

/// Upper bound of the overload: the inverse of the factor of no path is larger if its stress components do not exceed
/// these sizes.
inline double largest_overload(const Bond<double>& bond, const BondStress& sizes)
{
  return std::max(sizes.tension / bond.tensile_strength, cohesion_needed(bond, sizes) / bond.cohesion);
}
} // namespace feldspar

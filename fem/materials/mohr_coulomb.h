#pragma once

#include "fem/materials/material.h"

/// Elastic, perfectly plastic rock after Mohr and Coulomb: what a grain specimen is compared with.
///
/// Yield: k σ_1 - σ_3 ≤ q_u with principal stresses σ_1 ≥ σ_2 ≥ σ_3 (tension positive), k = (1 + sin φ)/(1 - sin φ),
/// q_u = 2 c √k. Flow: the same with the dilation angle ψ for φ. No softening; tension ends at the apex c cot φ.
///
/// One step is one backward Euler step from the old plastic strain, in principal stresses, where every yield surface is
/// a plane: onto one plane, onto the edge of two, or to the apex. Each return is exact, and so is the tangent, but for the
/// elastic share below. Units SI, angles in radians. Source: docs/theory.md §8.4. Pure; no storage, no files.
namespace feldspar::fem
{
/// Share of the elastic stiffness in the tangent of a stress on an edge or at the apex.
///
/// On an edge the stress does not resist a distortion between the two principal axes whose stresses are equal, at the apex
/// it resists nothing. A cylinder that yields in triaxial compression is on an edge everywhere: its exact tangent is singular,
/// and a correction by it is round-off. With this share the correction is the one without needless distortion. It leaves
/// the equilibrium as it is, and an error of Newton's method falls by some four orders of magnitude an iteration.
inline constexpr double elastic_share = 1e-6;

struct MohrCoulombParameters
{
  double youngs_modulus; ///< [Pa]
  double poissons_ratio;
  double cohesion;       ///< c [Pa]
  double friction_angle; ///< φ in [0, π/2)
  double dilation_angle; ///< ψ in [0, φ]
};

struct MohrCoulombState
{
  StrainVector<3> plastic_strain = StrainVector<3>::Zero();
  double dissipated = 0.0; ///< [J/m³]
  double stored = 0.0;     ///< elastic energy [J/m³]
};

struct MohrCoulombUpdate
{
  MaterialResponse<3> response;
  MohrCoulombState state;
};

/// Response and new state at a strain. Throws PointFailure if the strain is not finite.
MohrCoulombUpdate update(const MohrCoulombParameters& parameters, const MohrCoulombState& old,
                         const StrainVector<3>& strain);

/// Throws std::invalid_argument where a parameter is out of its range.
Material<3> mohr_coulomb(const MohrCoulombParameters& parameters);
} // namespace feldspar::fem

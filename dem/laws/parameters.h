#pragma once

#include <numbers>
#include <optional>

/// Parameters of contacts, in SI units and radians, tension positive. Default-constructed values are the defaults of the
/// input.
namespace feldspar
{
enum class StrengthDraw
{
  per_segment,
  per_contact
};

/// Distribution of the strengths of bonds, by mean and standard deviation.
enum class StrengthDistribution
{
  normal, ///< redrawn while negative
  weibull
};

/// The faces between the grains and their bonds.
struct FlatJointParameters
{
  unsigned int n_segments = 4;   ///< of a face in the plane
  unsigned int n_rings = 2;      ///< of a face in space
  unsigned int n_sectors = 4;    ///< of each ring
  double modulus = 80e9;         ///< E [Pa]; k_n = E/(R1+R2)
  double stiffness_ratio = 1.25; ///< κ = k_n/k_s
  double friction = 0.5;
  double radius_multiplier = 1.0;                               ///< λ; R̄ = λ min(R1, R2)
  double bond_tensile_strength = 22e6;                          ///< [Pa]
  double bond_tensile_strength_deviation = 2.2e6;               ///< [Pa]
  double bond_cohesion = 400e6;                                 ///< [Pa]
  double bond_cohesion_deviation = 40e6;                        ///< [Pa]
  double bond_friction_angle = 10.0 * std::numbers::pi / 180.0; ///< [rad]
  StrengthDistribution strength_distribution = StrengthDistribution::normal;
  StrengthDraw strength_draw = StrengthDraw::per_segment;
  std::optional<double> installation_gap_ratio = 0.05; ///< largest gap that gets a joint, over the mean radius
  std::optional<double> coordination_number;           ///< z = 2 joints/grains; instead of the gap, which follows
  double gapped_fraction = 0.0;                        ///< share of joints without bonds and with an initial gap
  double slit_fraction = 0.0;                          ///< share of joints without bonds whose faces are in contact
  double initial_gap = 0.0;                            ///< g_0 of the gapped joints [m]
};

/// The same faces, whose bonds soften beyond their strength.
struct SofteningFlatJointParameters : FlatJointParameters
{
  double softening_opening = 5e-6; ///< w, over which the stress of a bond falls to zero [m]
};

/// The bonds between the grains; the linear contact beside each is that of ParticleContactParameters.
struct ParallelBondParameters
{
  double modulus = 80e9;                         ///< E_b [Pa]; k_n = E_b/(R1+R2)
  double stiffness_ratio = 1.25;                 ///< κ_b = k_n/k_s
  double radius_multiplier = 1.0;                ///< λ; R̄ = λ min(R1, R2)
  double moment_contribution = 1.0;              ///< β, share of the moments that counts for breaking
  double bond_tensile_strength = 100e6;          ///< [Pa]
  double bond_tensile_strength_deviation = 10e6; ///< [Pa]
  double bond_cohesion = 100e6;                  ///< [Pa]
  double bond_cohesion_deviation = 10e6;         ///< [Pa]
  double bond_friction_angle = 0.0;              ///< [rad]
  StrengthDistribution strength_distribution = StrengthDistribution::normal;
  std::optional<double> installation_gap_ratio = 0.05; ///< as of the flat joint, and all below
  std::optional<double> coordination_number;
  double gapped_fraction = 0.0;
  double slit_fraction = 0.0;
  double initial_gap = 0.0; ///< [m]
};

/// A plane in the rock along which grains slide past one another: a flaw, or the boundary of a mineral grain.
struct SmoothJointParameters
{
  double normal_stiffness = 50e12; ///< k_n [Pa/m]
  double shear_stiffness = 20e12;  ///< k_s [Pa/m]
  double friction = 0.5;
  double dilation_angle = 0.0;          ///< ψ, below the angle of friction [rad]
  double tensile_strength = 0.0;        ///< σ_c of the bond [Pa]
  double cohesion = 0.0;                ///< c of the bond [Pa]
  std::optional<double> friction_angle; ///< φ of the bond; none: that of the friction [rad]
};

/// Pairs in contact without a face, grains at walls, and the contact beside a parallel bond.
struct ParticleContactParameters
{
  double modulus = 80e9; ///< E_c [Pa]
  double stiffness_ratio = 1.25;
  double friction = 0.5;
};
} // namespace feldspar

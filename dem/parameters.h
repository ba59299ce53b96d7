#pragma once

#include <cstdint>
#include <numbers>
#include <optional>
#include <string>

/// What the user may choose, in SI units and radians, tension positive. A default-constructed value is the default.
namespace feldspar
{
/// The body of grains to be made (or read).
struct SpecimenParameters
{
  unsigned int dimension = 2;
  std::string shape = "box";
  double width = 0.050;           ///< [m]
  double height = 0.100;          ///< along the axis of the test [m]
  double minimum_radius = 6.2e-4; ///< [m]
  double radius_ratio = 1.66;     ///< largest over smallest radius
  double porosity = 0.16;
  double bulk_density = 2700.0;       ///< [kg/m³]; a grain's is bulk / (1 - porosity)
  double packing_stress_ratio = 1e-4; ///< P_m/E*, mean stress of the packing over the grain contact modulus
  std::string packing_file;           ///< lines `x y [z] radius` in metres; empty: make a packing
  std::string specimen_file;          ///< a finished specimen.h5; empty: make one
};

enum class StrengthDraw
{
  per_segment,
  per_contact
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
  StrengthDraw strength_draw = StrengthDraw::per_segment;
  std::optional<double> installation_gap_ratio; ///< largest gap that gets a joint, over the mean radius
  std::optional<double> coordination_number;    ///< z = 2 joints/grains; the gap follows
  double gapped_fraction = 0.0;                 ///< share of joints without bonds and with an initial gap
  double slit_fraction = 0.0;                   ///< share of joints without bonds whose faces touch
  double initial_gap = 0.0;                     ///< g_0 of the gapped joints [m]
};

/// Pairs that touch without a face, and grains at walls.
struct ParticleContactParameters
{
  double modulus = 80e9; ///< E_c [Pa]
  double stiffness_ratio = 1.25;
  double friction = 0.5;
};

struct DynamicsParameters
{
  double damping = 0.7;          ///< α of the local non-viscous damping
  double time_step_safety = 0.8; ///< share of √(m/k) taken as step
};

/// What presses the side of a cylinder in a triaxial test.
enum class LateralBoundary
{
  wall,    ///< a rigid cylinder that shrinks and widens
  membrane ///< a pressure on the outer grains, each by its share of the side
};

/// The laboratory tests and when they end.
struct TestParameters
{
  double compression_strain_rate = 1.0;      ///< [1/s]
  double tension_strain_rate = 0.164;        ///< [1/s]
  double compression_sampling_strain = 1e-5; ///< strain between two rows of the curve
  double tension_sampling_strain = 1e-6;
  double brazilian_strain_rate = 0.164; ///< of the diameter [1/s]
  double brazilian_sampling_strain = 2e-6;
  double platen_friction = 0.0;
  double seating_transits = 10.0; ///< P-wave transits over which the confinement is raised
  LateralBoundary lateral_boundary = LateralBoundary::wall;
  std::optional<double> intermediate_stress; ///< σ_2 on a box in space, compression positive [Pa]; none: σ_3
  double brazilian_length_ratio = 0.5;       ///< length of the disc over its diameter, in space
  double grip_ratio = 0.1;                   ///< height of each grip over the specimen's
  double stop_strain_over_peak_strain = 1.6;
  std::optional<double> stop_strain;           ///< stop at this axial strain instead
  std::optional<double> stop_stress_over_peak; ///< or when the deviator has fallen to this share of its peak
};
} // namespace feldspar

#pragma once

#include "dem/lab/loading_stages.h"

#include <optional>
#include <string>
#include <vector>

/// Parameters of the laboratory tests, in SI units and radians, tension positive. Default-constructed values are the
/// defaults of the input.
namespace feldspar
{
/// The lateral boundary of a cylinder in a triaxial test.
enum class LateralBoundary
{
  wall,    ///< a rigid cylinder that shrinks and widens
  membrane ///< a pressure on the outer grains, each by its share of the side
};

/// Nothing that is rock is left at such a strain: every test ends there, whether its curve has peaked or not.
inline constexpr double largest_axial_strain = 0.2;

/// The laboratory tests and when they end.
struct TestParameters
{
  double compression_strain_rate = 1.0;      ///< [1/s]
  double tension_strain_rate = 0.164;        ///< [1/s]
  double compression_sampling_strain = 1e-5; ///< strain between two rows of the curve
  double tension_sampling_strain = 1e-6;
  double brazilian_strain_rate = 0.164; ///< of the diameter [1/s]
  double brazilian_sampling_strain = 2e-6;
  double bending_strain_rate = 0.1; ///< of the deflection over the depth of the beam [1/s]
  double bending_sampling_strain = 2e-6;
  double notch_ratio = 0.4;       ///< depth of the notch over that of the beam; 2 a / W of a cracked plate
  double shear_strain_rate = 0.1; ///< of the shear displacement over the length of the plane [1/s]
  double shear_sampling_strain = 1e-5;
  std::optional<double>
    shear_normal_stiffness;                 ///< of the rock around a sheared plane [Pa/m]; none: constant normal stress
  std::string loading_table;                ///< CSV file of the stages of own loading; empty: none
  std::vector<LoadingStage> loading_stages; ///< read from it
  unsigned int n_snapshots = 32;            ///< states of the grains that are kept, at most
  double platen_friction = 0.0;
  double seating_transits = 10.0; ///< P-wave transits over which the confinement is raised
  LateralBoundary lateral_boundary = LateralBoundary::wall;
  std::optional<double> intermediate_stress; ///< σ_2 on a box in space, compression positive [Pa]; none: σ_3
  double brazilian_length_ratio = 0.5;       ///< length of the disc over its diameter, in space
  double grip_ratio = 0.1;                   ///< height of each grip over the specimen's
  double stop_strain_over_peak_strain = 1.6;
  std::optional<double> stop_strain;           ///< stop at this axial strain instead
  std::optional<double> stop_stress_over_peak; ///< or when the deviator has fallen to this share of its peak
  std::optional<double> least_peak_stress;     ///< of a deviator that is a peak [Pa]; none: that of waves
  double least_transits_to_peak = 4.0;         ///< of a wave along the specimen
  double least_fall_after_peak = 0.05;         ///< of the deviator, over the peak
};
} // namespace feldspar

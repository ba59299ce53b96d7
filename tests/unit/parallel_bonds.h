#pragma once

#include "tests/unit/small_specimen.h"

#include <numbers>

/// Parallel bonds for tests.
namespace feldspar
{
/// All alike: 50 MPa in tension, 60 MPa and 30° in shear; the bond narrower than the grains and softer than their contact.
inline ParallelBondParameters test_bonds()
{
  ParallelBondParameters wanted;
  wanted.modulus = 40e9;
  wanted.stiffness_ratio = 2.0;
  wanted.radius_multiplier = 0.8;
  wanted.moment_contribution = 0.7;
  wanted.bond_tensile_strength = 50e6;
  wanted.bond_cohesion = 60e6;
  wanted.bond_tensile_strength_deviation = wanted.bond_cohesion_deviation = 0.0;
  wanted.bond_friction_angle = std::numbers::pi / 6.0;
  wanted.installation_gap_ratio = 1e-6;
  return wanted;
}
} // namespace feldspar

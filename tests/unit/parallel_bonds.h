#pragma once

#include "tests/unit/small_specimen.h"

#include <numbers>
#include <string_view>

/// Parallel bonds for tests, and specimens with them.
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

/// Some ninety grains in the plane, or 150 in a cylinder, joined by bonds of scattered strength.
template <int dim>
Specimen<dim> small_bonded_specimen()
{
  SpecimenParameters wanted;
  wanted.dimension = dim;
  wanted.shape = dim == 2 ? "box" : "cylinder";
  wanted.width = dim == 2 ? 0.012 : 0.008;
  wanted.height = dim == 2 ? 0.020 : 0.012;
  wanted.porosity = dim == 2 ? 0.16 : 0.40;
  ParallelBondParameters bonds = test_bonds();
  bonds.bond_tensile_strength_deviation = bonds.bond_cohesion_deviation = 10e6;
  bonds.installation_gap_ratio = 0.05;
  return make_specimen<dim>(wanted, bonds, {}, 1, [](std::string_view, double) {});
}
} // namespace feldspar

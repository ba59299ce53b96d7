#pragma once

#include "dem/genesis/genesis.h"
#include "laboratory/compression.h"
#include "laboratory/parameters.h"

#include <type_traits>

/// Specimens for tests that need one quickly.
namespace feldspar
{
/// Table 1 in a box of 12 × 20 mm: some ninety grains.
template <typename Joint = FlatJointParameters>
Specimen<2> small_specimen(const std::uint64_t seed = 1, const double bond_strength_factor = 1.0,
                           Joint flat_joint = Joint())
{
  SpecimenParameters wanted;
  wanted.width = 0.012;
  wanted.height = 0.020;
  flat_joint.coordination_number = 4.2;
  flat_joint.bond_tensile_strength *= bond_strength_factor;
  flat_joint.bond_cohesion *= bond_strength_factor;
  return make_specimen<2>(wanted, flat_joint, {}, seed);
}

/// Table 1 in a box of this size [m].
inline Specimen<2> granite_box(const double width, const double height)
{
  SpecimenParameters wanted;
  wanted.width = width;
  wanted.height = height;
  FlatJointParameters flat_joint;
  flat_joint.coordination_number = 4.2;
  return make_specimen<2>(wanted, flat_joint, {}, 1);
}

/// Table 1 in a cylinder (or box) of 8 × 12 mm: some 150 grains.
template <typename Joint = FlatJointParameters>
Specimen<3> small_cylinder(const std::uint64_t seed = 1, const double bond_strength_factor = 1.0,
                           const BodyShape shape = BodyShape::cylinder, Joint flat_joint = Joint())
{
  SpecimenParameters wanted;
  wanted.dimension = 3;
  wanted.shape = shape;
  wanted.width = 0.008;
  wanted.height = 0.012;
  wanted.porosity = 0.40; // of so small a body; the walls leave voids
  flat_joint.installation_gap_ratio = 0.05;
  flat_joint.bond_tensile_strength *= bond_strength_factor;
  flat_joint.bond_cohesion *= bond_strength_factor;
  return make_specimen<3>(wanted, flat_joint, {}, seed);
}

/// Compression in some thousand steps.
inline TestParameters quick_compression()
{
  TestParameters wanted;
  wanted.of<CompressionParameters>().strain_rate = 2.0;
  wanted.of<CompressionParameters>().sampling_strain = 5e-5;
  return wanted;
}

/// Grains where one wants them, density 3000 kg/m³, no joints.
template <int dim = 2>
Specimen<dim> placed_specimen(const std::vector<double>& radii, const std::type_identity_t<Components<dim>>& positions)
{
  Specimen<dim> specimen;
  specimen.size.setOnes();
  specimen.particle_contact.friction = 0.0;
  specimen.grains.place(radii, positions);
  specimen.grains.set_density(3000.0, specimen.thickness);
  return specimen;
}
} // namespace feldspar

#pragma once

#include "dem/genesis/genesis.h"
#include "laboratory/compression.h"
#include "laboratory/parameters.h"

#include <gtest/gtest.h>

#include <type_traits>

/// Specimens for tests that need one quickly.
namespace feldspar
{
/// For tests of both kinds: TYPED_TEST_SUITE(Suite, Dimensions).
using Dimensions = testing::Types<std::integral_constant<int, 2>, std::integral_constant<int, 3>>;

/// Table 1 in a box of this size [m].
template <typename Joint = FlatJointParameters>
Specimen<2> granite_box(const double width, const double height, Joint joint = Joint(), const std::uint64_t seed = 1,
                        const ParticleContactParameters& contact = {})
{
  SpecimenParameters wanted;
  wanted.width = width;
  wanted.height = height;
  joint.coordination_number = 4.2;
  return make_specimen<2>(wanted, joint, contact, seed);
}

/// Table 1 in a body of this size [m].
template <typename Joint = FlatJointParameters>
Specimen<3> granite_in_space(const BodyShape shape, const double width, const double height, Joint joint = Joint(),
                             const std::uint64_t seed = 1)
{
  SpecimenParameters wanted;
  wanted.dimension = 3;
  wanted.shape = shape;
  wanted.width = width;
  wanted.height = height;
  wanted.porosity = 0.40; // of a small body; the walls leave voids
  joint.installation_gap_ratio = 0.05;
  return make_specimen<3>(wanted, joint, {}, seed);
}

template <typename Joint>
Joint strengthened(Joint joint, const double factor)
{
  joint.bond_tensile_strength *= factor;
  joint.bond_cohesion *= factor;
  return joint;
}

/// Table 1 in a box of 12 × 20 mm: some ninety grains.
template <typename Joint = FlatJointParameters>
Specimen<2> small_specimen(const std::uint64_t seed = 1, const double bond_strength_factor = 1.0,
                           const Joint& joint = Joint())
{
  return granite_box(0.012, 0.020, strengthened(joint, bond_strength_factor), seed);
}

/// Table 1 in a cylinder (or box) of 8 × 12 mm: some 150 grains.
template <typename Joint = FlatJointParameters>
Specimen<3> small_cylinder(const std::uint64_t seed = 1, const double bond_strength_factor = 1.0,
                           const BodyShape shape = BodyShape::cylinder, const Joint& joint = Joint())
{
  return granite_in_space(shape, 0.008, 0.012, strengthened(joint, bond_strength_factor), seed);
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

// Specimens of joint laws other than the flat joint: time step, energies, threads, files and a resumed test.

#include "base/input_error.h"
#include "dem/dynamics/dynamics.h"
#include "dem/lab/protocols/grips.h"
#include "dem/lab/protocols/protocols.h"
#include "dem/specimen/specimen_file.h"
#include "laboratory/compression.h"
#include "results/evaluation.h"
#include "tests/temporary_folder.h"
#include "tests/unit/parallel_bonds.h"
#include "tests/unit/same_bits.h"
#include "tests/unit/whole_tests.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <utility>
#include <variant>
#include <vector>

namespace feldspar
{
namespace
{
/// A law, the dimension, and bonds to test it by.
template <int n>
struct ParallelBonds
{
  static constexpr int dim = n;
  using Law = ParallelBond<n>;
  static ParallelBondParameters bonds() { return test_bonds(); }
};

template <int n>
struct SofteningJoints
{
  static constexpr int dim = n;
  using Law = SofteningFlatJoint<n>;
  /// Bonds that lose their stress over half of their opening at the strength.
  static SofteningFlatJointParameters bonds()
  {
    SofteningFlatJointParameters wanted;
    wanted.bond_tensile_strength = 50e6;
    wanted.bond_cohesion = 60e6;
    wanted.softening_opening = 5e-7;
    return wanted;
  }
};

template <typename>
using LaboratoryTests = testing::Test;

using OtherLaws = testing::Types<ParallelBonds<2>, ParallelBonds<3>, SofteningJoints<2>, SofteningJoints<3>>;
TYPED_TEST_SUITE(LaboratoryTests, OtherLaws);

/// Some ninety grains in the plane, or 150 in a cylinder, joined by bonds of scattered strength.
template <typename Case>
Specimen<Case::dim> small_bonded_specimen()
{
  constexpr int dim = Case::dim;
  SpecimenParameters wanted;
  wanted.dimension = dim;
  wanted.shape = dim == 2 ? BodyShape::box : BodyShape::cylinder;
  wanted.width = dim == 2 ? 0.012 : 0.008;
  wanted.height = dim == 2 ? 0.020 : 0.012;
  wanted.porosity = dim == 2 ? 0.16 : 0.40;
  auto bonds = Case::bonds();
  bonds.bond_tensile_strength_deviation = bonds.bond_cohesion_deviation = 10e6;
  bonds.installation_gap_ratio = 0.05;
  return make_specimen<dim>(wanted, bonds, {}, 1);
}

TestParameters quick_and_dense()
{
  TestParameters wanted;
  wanted.of<CompressionParameters>().strain_rate = 2.0;
  wanted.of<TensionParameters>().strain_rate = 2.0;
  wanted.of<CompressionParameters>().sampling_strain = 2e-5;
  return wanted;
}

TEST(ParallelBondTimeStep, IsThatOfBondAndContactTogether)
{
  // A pair: k = K_bond + K_contact along it, against R's mass; turning by (k_s A + K_s)R² + k_n I against ½mR².
  auto wanted = test_bonds();
  const double radius = 1e-3;
  auto specimen = placed_specimen({radius, radius}, {{{0.5, 0.5 + 2.0 * radius}, {0.5, 0.5}}});
  specimen.particle_contact = {60e9, 1.5, 0.4};
  install_joints(specimen, wanted);
  const double half = 0.8 * radius;
  const double k_n = 40e9 / (2.0 * radius);
  const double along = k_n * 2.0 * half + 60e9;
  const double turning = (0.5 * k_n * 2.0 * half + 60e9 / 1.5) * radius * radius + k_n * 2.0 / 3.0 * half * half * half;
  const double mass = specimen.grains.mass[0];
  const double largest = std::max(along / mass, turning / (0.5 * mass * radius * radius));
  Dynamics<2> dynamics(std::move(specimen), {0.0, 0.8}, ZeroForce::as_placed);
  dynamics.step();
  EXPECT_NEAR(dynamics.time_step(), 0.8 / std::sqrt(largest), 1e-12 * dynamics.time_step());
}

TYPED_TEST(LaboratoryTests, APressedSpecimenBreaksAndItsEnergiesBalanceAllTheWay)
{
  constexpr int dim = TypeParam::dim;
  const auto record =
    tests::balanced_outcome_of<dim>({uniaxial_compression}, small_bonded_specimen<TypeParam>(), quick_and_dense())
      .record;
  const auto results = evaluate(record);
  ASSERT_TRUE(results.peak_stress.value) << results.peak_stress.reason;
  EXPECT_GT(*results.peak_stress.value, 20e6);
  EXPECT_GT(record.cracks.size(), 5u);
  const Energies& at_end = record.curve.back().energies;
  const double largest_work = std::ranges::max(record.curve, {}, [](const CurveSample& row) {
                                return row.energies.boundary_work;
                              }).energies.boundary_work;
  EXPECT_GT(at_end.slip, 0.02 * largest_work);
  EXPECT_GT(at_end.released, 0.02 * largest_work);
  // One crack of each bond at most.
  std::vector<std::pair<std::uint32_t, std::uint32_t>> bonds;
  for (const auto& crack : record.cracks)
    bonds.emplace_back(crack.joint, crack.segment);
  std::sort(bonds.begin(), bonds.end());
  EXPECT_EQ(std::adjacent_find(bonds.begin(), bonds.end()), bonds.end());
}

TYPED_TEST(LaboratoryTests, GiveTheSameBitsWithOneThreadAndTwo)
{
  tests::expect_same_bits_on_two_threads(small_bonded_specimen<TypeParam>(), quick_and_dense(), 60);
}

TYPED_TEST(LaboratoryTests, ComeBackFromAFileAndATestTakenUpGivesTheSameBits)
{
  constexpr int dim = TypeParam::dim;
  const tests::TemporaryFolder folder;
  const auto specimen = small_bonded_specimen<TypeParam>();
  write_specimen(specimen, folder.path() / "specimen.h5");
  const auto back = read_specimen<dim>(folder.path() / "specimen.h5");
  EXPECT_TRUE(std::holds_alternative<typename TypeParam::Law>(back.joints.law));
  EXPECT_EQ(back.joints.n_more, TypeParam::Law::n_more);
  EXPECT_EQ(back.joints.tensile_strength, specimen.joints.tensile_strength);
  EXPECT_EQ(back.joints.friction, specimen.joints.friction);

  // The specimen that was read, whose law brings its own numbers, and a checkpoint in the middle of breaking.
  tests::expect_same_bits_when_resumed(specimen, back, quick_and_dense(), 40, 25);
}

TEST(ParallelBondFile, AFileWithImpossibleNumbersOfTheLawIsRefused)
{
  const tests::TemporaryFolder folder;
  auto specimen = small_bonded_specimen<ParallelBonds<2>>();
  ParallelBondParameters wrong = test_bonds();
  wrong.moment_contribution = 2.0;
  specimen.joints.law = ParallelBond<2>(wrong, {});
  write_specimen(specimen, folder.path() / "specimen.h5");
  EXPECT_THROW(read_specimen<2>(folder.path() / "specimen.h5"), InputError);
}
} // namespace
} // namespace feldspar

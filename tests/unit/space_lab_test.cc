// Laboratory tests on cylinders.

#include "base/input_error.h"
#include "dem/lab/laboratory_run.h"
#include "dem/lab/protocols/bending.h"
#include "dem/lab/protocols/grips.h"
#include "dem/lab/protocols/parameters.h"
#include "dem/lab/protocols/protocols.h"
#include "dem/lab/surroundings.h"
#include "laboratory/compression.h"
#include "results/evaluation.h"
#include "tests/temporary_folder.h"
#include "tests/unit/small_specimen.h"
#include "tests/unit/whole_tests.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <numbers>
#include <string>
#include <utility>
#include <vector>

namespace feldspar
{
namespace
{
using std::numbers::pi;

TestParameters quick_in_space()
{
  TestParameters wanted;
  wanted.of<CompressionParameters>().strain_rate = 4.0;
  wanted.of<TensionParameters>().strain_rate = 1.0;
  wanted.of<CompressionParameters>().sampling_strain = 5e-5;
  wanted.of<TensionParameters>().sampling_strain = 5e-6;
  wanted.of<BrazilianParameters>().strain_rate = 1.0;
  wanted.of<BrazilianParameters>().sampling_strain = 2e-5;
  wanted.stop_strain_over_peak_strain = 1.1;
  return wanted;
}

TestOutcome quickly(const LaboratoryCase& test, const Specimen<3>& specimen)
{
  return tests::outcome_of<3>(test, specimen, quick_in_space());
}

TEST(SpaceLab, BreaksACylinderInTensionAndCompression)
{
  const auto specimen = small_cylinder();
  const auto pulled = evaluate(quickly({direct_tension}, specimen).record);
  const auto outcome = quickly({uniaxial_compression}, specimen);
  const auto& record = outcome.record;
  const auto& snapshots = outcome.appearance.snapshots;
  const auto crushed = evaluate(record);
  ASSERT_TRUE(pulled.peak_stress.value && crushed.peak_stress.value) << pulled.peak_stress.reason;
  // Below the strength of its bonds in tension; several times stronger in compression, as rock is.
  EXPECT_LT(*pulled.peak_stress.value, 22e6);
  EXPECT_GT(*crushed.peak_stress.value, 4.0 * *pulled.peak_stress.value);
  EXPECT_EQ(pulled.n_shear_cracks, 0u);
  EXPECT_LT(crushed.energy_imbalance, 0.01);
  EXPECT_GT(*crushed.youngs_modulus_initial.value, 10e9);
  // Data that the pictures need: of every grain, from the start to the end.
  ASSERT_GT(snapshots.size(), 4u);
  EXPECT_TRUE(std::ranges::equal(snapshots.front().position[2], specimen.grains.position[2]));
  std::size_t n_broken = 0;
  for (const auto n : snapshots.back().n_broken_segments)
    n_broken += n;
  EXPECT_GT(n_broken, 0u);
  EXPECT_LE(n_broken, 2 * record.cracks.size()); // each crack lies at two grains
}

TEST(SpaceLab, ConfinedByAWallItIsStrongerAndTheWorkIsCounted)
{
  const auto specimen = small_cylinder();
  const double alone = *evaluate(quickly({uniaxial_compression}, specimen).record).peak_stress.value;
  const auto record = quickly({triaxial_compression, 20e6}, specimen).record;
  const auto results = evaluate(record);
  ASSERT_TRUE(results.peak_stress.value) << results.peak_stress.reason;
  EXPECT_GT(*results.peak_stress.value, alone + 20e6);
  EXPECT_LT(results.energy_imbalance, 0.01);
  EXPECT_NEAR(record.curve.front().axial_stress, -20e6, 0.01 * 20e6); // within the tolerance of the seating
  EXPECT_LT(*results.servo_error.value, 0.01);
}

TEST(SpaceLab, PressesABoxByThreeStresses)
{
  auto wanted = quick_in_space();
  wanted.of<ConfinementParameters>().intermediate_stress = 30e6;
  wanted.stop_strain = 1e-4;
  const auto box = small_cylinder(1, 1e3, BodyShape::box);
  auto set_up = triaxial_compression.set_up<3>().value()(box, 10e6, wanted, {});
  EXPECT_EQ(LabTest<3>({triaxial_compression, 10e6}, box, wanted, {}).finish(true).record.intermediate_stress, 30e6);
  EXPECT_FALSE(
    LabTest<3>({triaxial_compression, 30e6}, box, wanted, {}).finish(true).record.intermediate_stress); // the same
  set_up.loading.seat(set_up.dynamics, [] {});
  const Tensor<3> stress = set_up.dynamics.mean_stress();
  // Pressures on the walls are within 0.5 %; what the walls cut off the body is of the order of its overlaps.
  EXPECT_NEAR(stress(0, 0), -10e6, 0.03 * 30e6);
  EXPECT_NEAR(stress(1, 1), -30e6, 0.03 * 30e6);
  EXPECT_NEAR(stress(2, 2), -10e6, 0.03 * 30e6);
}

TEST(SpaceLab, SplitsADiscAlongTheLoad)
{
  const auto specimen = granite_in_space(BodyShape::cylinder, 0.010, 0.008);
  const auto outcome = quickly({brazilian}, specimen);
  const auto& record = outcome.record;
  const auto results = evaluate(record);
  ASSERT_TRUE(results.peak_stress.value) << results.peak_stress.reason;
  EXPECT_GT(*results.peak_stress.value, 2e6);
  EXPECT_LT(*results.peak_stress.value, 60e6);
  // Lying across: half as long as wide, in a box of that size, and only that part is tested.
  EXPECT_EQ(record.size, (std::array<double, 3>{0.010, 0.005, 0.010}));
  EXPECT_LT(record.specimen.n_grains, specimen.grains.size());
  for (const auto& grain : outcome.appearance.grains_at_end)
    EXPECT_LT(std::abs(grain.position[1] - 0.0025), 0.0026);
}

/// The protocols whose body, cut out of a specimen of this size, is as large as they say, by name.
std::vector<std::string> cut_as_said(const double width, const double height)
{
  std::vector<std::string> names;
  for (const LaboratoryProtocol* const protocol : laboratory_protocols())
    if (const auto& size = protocol->body_size<2>())
      for (std::uint64_t seed = 1; seed <= 10; ++seed) // not every disc has grains where it is loaded
        try
          {
            const auto specimen = granite_box(width, height, FlatJointParameters(), seed);
            const TestParameters parameters;
            const auto test = (*protocol->set_up<2>())(specimen, 0.0, parameters, {});
            EXPECT_LT((test.dynamics.specimen().size - (*size)(specimen, parameters)).norm(), 1e-15)
              << protocol->kind.name;
            names.emplace_back(protocol->kind.name);
            break;
          }
        catch (const InputError&)
          {
          }
  return names;
}

/// Grains of the lower and the upper pad of the disc that is cut from a specimen of discs: those that set off with a platen.
std::vector<std::size_t> pads_of(const double width, const double height, const std::uint64_t seed)
{
  SpecimenParameters wanted;
  wanted.width = width;
  wanted.height = height;
  FlatJointParameters joint;
  joint.installation_gap_ratio = 0.05;
  const auto specimen = make_specimen<2>(wanted, joint, {}, seed);
  const TestParameters parameters;
  const auto test = (*brazilian.set_up<2>())(specimen, 0.0, parameters, {});
  const Specimen<2>& disc = test.dynamics.specimen();
  const auto& velocity = disc.grains.velocity;
  const double speed = 0.5 * parameters.of<BrazilianParameters>().strain_rate * disc.size[0];
  std::vector<std::size_t> n_grains;
  for (const double of_pad : {speed, -speed})
    n_grains.push_back(std::size_t(std::count(velocity[1].begin(), velocity[1].end(), of_pad)));
  return n_grains;
}

// Walls touch the rim of a disc of a square specimen at its poles, where no grain lies wholly within the circle. The pads are
// then brought to the outermost grains: of 30 mm once all of eight seeds were refused, of 50 mm the first two.
TEST(BrazilianDisc, OfASquareSpecimenIsHeldByItsOutermostGrains)
{
  for (const auto& [width, n_seeds] : {std::pair(0.030, 8), {0.050, 2}})
    for (int seed = 1; seed <= n_seeds; ++seed)
      for (const std::size_t n : pads_of(width, width, std::uint64_t(seed)))
        {
          EXPECT_GE(n, 1u) << width << " m, seed " << seed;
          EXPECT_LE(double(n), 1.0 + width * std::sin(10.0 * pi / 180.0) / 1.2e-3) << width << " m, seed " << seed;
        }
}

// The record of a test that cannot be made has the body on which the test would have been made.
TEST(BodySize, IsThatOfTheBodyThatIsCut)
{
  const std::vector<std::string> all{"brazilian", "three_point_bending", "semicircular_bending"};
  EXPECT_EQ(cut_as_said(0.020, 0.030), all);
  EXPECT_EQ(cut_as_said(0.030, 0.020), all);
}

// In space: of a core a disc and a half disc lie on their sides, a beam is cut out of boxes alone.
TEST(BodySize, InSpaceIsThatOfTheBodyThatIsCut)
{
  const auto core = small_cylinder();
  const TestParameters wanted;
  const auto& size = *brazilian.body_size<3>();
  const auto disc = (*brazilian.set_up<3>())(core, 0.0, wanted, {});
  EXPECT_LT((disc.dynamics.specimen().size - size(core, wanted)).norm(), 1e-15);
  const Vector<3> half = (*semicircular_bending.body_size<3>())(core, wanted);
  EXPECT_NEAR(half[0], 8e-3, 1e-15);
  EXPECT_NEAR(half[1], 8e-3 * wanted.of<BrazilianParameters>().length_ratio, 1e-15);
  EXPECT_NEAR(half[2], 4e-3, 1e-15);
  const auto box = small_cylinder(1, 1.0, BodyShape::box);
  const Vector<3> beam = (*three_point_bending.body_size<3>())(box, wanted);
  EXPECT_NEAR(beam[0], 12e-3, 1e-15); // its height lies down
  EXPECT_NEAR(beam[1], 8e-3, 1e-15);
  EXPECT_NEAR(beam[2], 12e-3 / 4.4, 1e-15);
}

// A roller that rested on one sphere would let the half disc tilt about it; one that pivots rests on two at least.
TEST(SpaceLab, BendsAHalfDiscOnLinesOfGrains)
{
  const auto specimen = granite_in_space(BodyShape::box, 0.012, 0.012);
  auto test = (*semicircular_bending.set_up<3>())(specimen, 0.0, quick_in_space(), {});
  auto& dynamics = test.dynamics;
  ASSERT_EQ(dynamics.walls().size(), 3u);
  const Wall& upper = dynamics.walls().back();
  const double start = upper.position;
  while (start - upper.position < 2e-6)
    dynamics.step();
  for (std::size_t wall = 0; wall < 3; ++wall)
    {
      const double of_one = Walls<3>::stiffness(dynamics.specimen(), specimen.report.mean_radius);
      EXPECT_GT(dynamics.wall_stiffness_in_touch(wall), 3.0 * of_one);
    }
  EXPECT_NEAR(dynamics.wall_force(0), dynamics.wall_force(1), 0.2 * dynamics.wall_force(0));
}

TEST(SpaceLab, AHalfDiscOnBeddedRollersReadBackRunsOnToTheSameBits)
{
  TestParameters wanted = quick_in_space();
  wanted.of<BendingParameters>().strain_rate = 0.5;
  wanted.of<BendingParameters>().sampling_strain = 1e-5;
  const auto specimen = granite_in_space(BodyShape::box, 0.012, 0.012);
  const tests::TemporaryFolder folder;
  LabTest<3> whole({semicircular_bending}, specimen, wanted, {});
  for (int k = 0; k < 8; ++k)
    whole.advance();
  whole.write_checkpoint(folder.path() / "test.h5", "one");
  LabTest<3> again({semicircular_bending}, specimen, wanted, {});
  again.read_checkpoint(folder.path() / "test.h5", "one");
  for (int k = 0; k < 8; ++k)
    {
      whole.advance();
      again.advance();
    }
  const auto one = whole.finish(true);
  const auto two = again.finish(true);
  EXPECT_NE(one.record.curve.back().axial_stress, 0.0);
  EXPECT_EQ(one.record.curve.back().axial_stress, two.record.curve.back().axial_stress);
  EXPECT_EQ(one.record.curve.back().energies.boundary_work, two.record.curve.back().energies.boundary_work);
  ASSERT_EQ(one.appearance.snapshots.size(), two.appearance.snapshots.size());
  EXPECT_EQ(one.appearance.snapshots.back().position, two.appearance.snapshots.back().position);
}
} // namespace
} // namespace feldspar

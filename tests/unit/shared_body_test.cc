// One body that several processes compute together, threads in their place.

#include "base/byte_archive.h"
#include "base/input_error.h"
#include "base/whole_file.h"
#include "dem/flaws/apply.h"
#include "dem/lab/laboratory_run.h"
#include "dem/lab/protocols/bending.h"
#include "dem/lab/protocols/grips.h"
#include "dem/lab/protocols/parameters.h"
#include "dem/lab/protocols/protocols.h"
#include "dem/lab/surroundings.h"
#include "dem/sharing/body_share.h"
#include "laboratory/compression.h"
#include "laboratory/loading_stages.h"
#include "tests/temporary_folder.h"
#include "tests/thread_partners.h"
#include "tests/unit/small_specimen.h"
#include "tests/words.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <numeric>
#include <tuple>
#include <vector>

namespace feldspar
{
namespace
{
using tests::ThreadPartners;

TestParameters quick(const LateralBoundary boundary = LateralBoundary::wall)
{
  TestParameters wanted;
  wanted.of<CompressionParameters>().strain_rate = 4.0;
  wanted.of<TensionParameters>().strain_rate = 1.0;
  wanted.of<CompressionParameters>().sampling_strain = 5e-5;
  wanted.of<TensionParameters>().sampling_strain = 5e-6;
  wanted.of<ConfinementParameters>().lateral_boundary = boundary;
  wanted.stop_strain_over_peak_strain = 1.1;
  return wanted;
}

/// All that a test measures and its body is at the end.
struct Measured
{
  std::vector<CurveSample> curve;
  std::vector<Crack> cracks;
  std::vector<EmissionEvent> events;
  std::vector<Snapshot> snapshots;
  std::vector<std::vector<double>> grains;
};

template <int dim>
Measured measured(LabTest<dim>& test)
{
  const TestOutcome outcome = test.finish(false);
  Measured all{outcome.record.curve, outcome.record.cracks, outcome.record.events, outcome.appearance.snapshots, {}};
  for (const auto& grain : outcome.appearance.grains_at_end)
    all.grains.push_back({grain.position[0], grain.position[1], grain.position[2], double(grain.fragment)});
  return all;
}

void expect_same(const Measured& one, const Measured& other)
{
  ASSERT_EQ(one.curve.size(), other.curve.size());
  for (std::size_t k = 0; k < one.curve.size(); ++k)
    for (const auto& column : curve_columns)
      EXPECT_EQ(std::bit_cast<std::uint64_t>(column.get(one.curve[k])),
                std::bit_cast<std::uint64_t>(column.get(other.curve[k])))
        << column.name << " in row " << k;
  ASSERT_EQ(one.cracks.size(), other.cracks.size());
  const auto numbers = [](const Crack& crack) {
    return std::tuple(crack.kind, crack.joint, crack.segment, crack.step, crack.axial_strain, crack.centroid,
                      crack.normal, crack.size, crack.released_energy, crack.event);
  };
  for (std::size_t k = 0; k < one.cracks.size(); ++k)
    EXPECT_EQ(numbers(one.cracks[k]), numbers(other.cracks[k])) << "crack " << k;
  ASSERT_EQ(one.events.size(), other.events.size());
  for (std::size_t k = 0; k < one.events.size(); ++k)
    EXPECT_EQ(one.events[k].moment, other.events[k].moment) << "event " << k;
  ASSERT_EQ(one.snapshots.size(), other.snapshots.size());
  for (std::size_t k = 0; k < one.snapshots.size(); ++k)
    {
      EXPECT_EQ(one.snapshots[k].position, other.snapshots[k].position);
      EXPECT_EQ(one.snapshots[k].stress, other.snapshots[k].stress);
      EXPECT_EQ(one.snapshots[k].fragment, other.snapshots[k].fragment);
      EXPECT_EQ(one.snapshots[k].n_broken_segments, other.snapshots[k].n_broken_segments);
    }
  EXPECT_EQ(one.grains, other.grains);
}

/// A test from its start to `n_rows` by partners together, whose state is then taken up by `n_after` of them; by one process
/// where a number is 1.
template <int dim>
Measured led(const LaboratoryCase& which, const Specimen<dim>& specimen, const TestParameters& wanted,
             const unsigned int n_before, const std::size_t n_rows, const unsigned int n_after)
{
  const tests::TemporaryFolder folder;
  const auto lead = [&](const unsigned int n, const bool resumes, const std::size_t last_row) {
    const auto work = [&](Partners& partners) {
      LabTest<dim> test(which, specimen, wanted, {});
      if (n > 1)
        test.share(partners);
      if (resumes)
        test.read_checkpoint(folder.path() / "kept.h5", "it");
      test.meet();
      constexpr std::size_t rows_between_checkpoints = 15;
      while (!test.has_ended() && test.curve().size() < last_row)
        {
          test.advance();
          if (test.curve().size() % rows_between_checkpoints == 0)
            test.write_checkpoint(folder.path() / "between.h5", "it");
        }
      test.write_checkpoint(folder.path() / (resumes ? "end.h5" : "kept.h5"), "it");
    };
    ThreadPartners(n).run(work);
  };
  lead(n_before, false, n_rows);
  lead(n_after, true, 1000000);
  LabTest<dim> whole(which, specimen, wanted, {});
  whole.read_checkpoint(folder.path() / "end.h5", "it");
  return measured(whole);
}

template <int dim>
Measured alone(const LaboratoryCase& which, const Specimen<dim>& specimen, const TestParameters& wanted)
{
  LabTest<dim> test(which, specimen, wanted, {});
  while (test.advance())
    ;
  return measured(test);
}

/// More cracks than `least`; numbers as of `led`.
template <int dim>
void expect_the_bits_of_one_process(const LaboratoryCase& which, const Specimen<dim>& specimen,
                                    const TestParameters& wanted, const std::size_t least, const unsigned int n_before,
                                    const std::size_t n_rows, const unsigned int n_after)
{
  SCOPED_TRACE(which.protocol.kind.name);
  const Measured one = alone<dim>(which, specimen, wanted);
  ASSERT_GT(one.cracks.size(), least);
  expect_same(one, led<dim>(which, specimen, wanted, n_before, n_rows, n_after));
}

TEST(SharedBody, TensionInThePlaneHasTheBitsOfOneProcess)
{
  expect_the_bits_of_one_process<2>({direct_tension}, small_specimen(), quick(), 10, 2, 10, 3);
}

TEST(SharedBody, CompressionInThePlaneHasTheBitsOfOneProcess)
{
  const auto specimen = small_specimen();
  const Measured one = alone<2>({uniaxial_compression}, specimen, quick());
  ASSERT_GT(one.cracks.size(), 50u);
  expect_same(one, led<2>({uniaxial_compression}, specimen, quick(), 3, 40, 1));
  expect_same(one, led<2>({uniaxial_compression}, specimen, quick(), 1, 40, 8));
}

TEST(SharedBody, UnderServoAndMembraneHasTheBitsOfOneProcess)
{
  const auto specimen = small_specimen();
  for (const LateralBoundary boundary : {LateralBoundary::wall, LateralBoundary::membrane})
    expect_the_bits_of_one_process<2>({triaxial_compression, 20e6}, specimen, quick(boundary), 50, 2, 40, 5);
}

TEST(SharedBody, CylinderHasTheBitsOfOneProcess)
{
  const auto specimen = small_cylinder();
  for (const LaboratoryCase& which : {LaboratoryCase{direct_tension}, LaboratoryCase{triaxial_compression, 10e6}})
    expect_the_bits_of_one_process(which, specimen, quick(), 10, 3, 20, 2);
}

TEST(SharedBody, DiscPlateAndShearBoxHaveTheBitsOfOneProcess)
{
  const auto specimen = granite_box(0.020, 0.020);
  TestParameters wanted = quick();
  wanted.of<ShearParameters>().strain_rate = 2.0;
  wanted.of<ShearParameters>().sampling_strain = 1e-4;
  wanted.of<BrazilianParameters>().strain_rate = 0.8;
  wanted.of<BrazilianParameters>().sampling_strain = 1e-5;
  for (const LaboratoryCase& which :
       {LaboratoryCase{brazilian}, LaboratoryCase{centre_cracked_plate}, LaboratoryCase{direct_shear, 5e6}})
    expect_the_bits_of_one_process(which, specimen, wanted, 5, 2, 20, 3);
}

TEST(SharedBody, WithAClosedFlawAndAHoleHasTheBitsOfOneProcess)
{
  auto specimen = granite_box(0.016, 0.024);
  put_in_flaws<2>(specimen,
                  {ClosedFlaw{{{0.004, 0.014}, {0.012, 0.010}}}, EllipseHole{{0.008, 0.006}, {0.002, 0.001}}});
  expect_the_bits_of_one_process<2>({uniaxial_compression}, specimen, quick(), 50, 3, 40, 3);
}

/// Two bonded smooth joints across a box.
Specimen<2> box_with_smooth_joints()
{
  auto specimen = granite_box(0.016, 0.024);
  SmoothSides bonded;
  bonded.tensile_strength = 3e6;
  bonded.cohesion = 6e6;
  put_in_flaws<2>(specimen, {ClosedFlaw{{{0.0, 0.006}, {0.016, 0.018}}, bonded},
                             ClosedFlaw{{{0.004, 0.004}, {0.012, 0.004}}, bonded}});
  return specimen;
}

TEST(SharedBody, KeepsItsOwnSmoothJointsWhenTheFirstWritesAll)
{
  const auto specimen = box_with_smooth_joints();
  ThreadPartners(3).run([&](Partners& partners) {
    Dynamics<2> part(specimen, {}, ZeroForce::at_touch);
    part.share(partners);
    for (const bool again : {false, true})
      {
        part.step();
        std::size_t n_counted = 0;
        for (const SmoothJoint<2>& joint : part.specimen().smooth_joints)
          {
            EXPECT_TRUE(part.sharing().concerns(joint.ends())) << again;
            n_counted += part.sharing().counts(joint.grain_1);
          }
        EXPECT_EQ(part.sharing().gathered(std::vector(n_counted, 1)).size(), specimen.smooth_joints.size()) << again;
        part.know_all();
        NothingWriter nothing;
        part.transfer(nothing);
      }
  });
}

TEST(SharedBody, WithSmoothJointsHasTheBitsOfOneProcess)
{
  const auto specimen = box_with_smooth_joints();
  ASSERT_GT(specimen.smooth_joints.size(), 10u);
  const Measured one = alone<2>({uniaxial_compression}, specimen, quick());
  EXPECT_GT(std::ranges::count_if(one.cracks, &Crack::on_smooth_joint), 5);
  expect_same(one, led<2>({uniaxial_compression}, specimen, quick(), 3, 40, 2));
}

TEST(SharedBody, ThatCannotBeWrittenIsAnErrorOnAllProcesses)
{
  const auto specimen = small_specimen();
  ThreadPartners(3).run([&](Partners& partners) {
    LabTest<2> test({direct_tension}, specimen, quick(), {});
    test.share(partners);
    test.advance();
    EXPECT_THROW(test.write_checkpoint("/nowhere/test.h5", "it"), OutputError);
    EXPECT_TRUE(test.advance()) << "it can go on";
  });
}

// The disk may be full in the middle: the others are not left waiting.
TEST(SharedBody, WhoseFirstProcessGivesUpWritingIsAnErrorOnTheOthers)
{
  const auto specimen = small_specimen();
  ThreadPartners(3).run([&](Partners& partners) {
    Dynamics<2> part(specimen, {}, ZeroForce::at_touch);
    part.share(partners);
    part.step();
    part.know_all();
    NothingWriter nothing;
    if (partners.mine() > 0)
      EXPECT_THROW(part.transfer(nothing), OutputError);
    else
      {
        for (int column = 0; column < 5; ++column)
          part.sharing().gathered_by_first(std::vector<std::uint8_t>());
        part.sharing().any(true);
      }
    part.step();
  });
}

BodyShare<2> share_of(Partners& partners, const Specimen<2>& body)
{
  const auto& joints = body.joints;
  return {partners, work_of_joints<2>(body.grains.size(), joints.law, joints.grain_1, joints.bonded, {})};
}

TEST(SharedBody, IsDividedAnewWhereItsBondsHaveBroken)
{
  const auto specimen = granite_box(0.020, 0.040);
  const std::size_t n_grains = specimen.grains.size();
  ThreadPartners(2).run([&](Partners& partners) {
    const BodyShare<2> before = share_of(partners, specimen);
    EXPECT_DOUBLE_EQ(before.unevenness(specimen), 1.0);
    Specimen<2> broken = specimen;
    auto& joints = broken.joints;
    for (std::size_t j = 0; j < joints.size(); ++j)
      if (joints.grain_1[j] < n_grains / 2)
        joints.bonded[joints.segment(0, j)] = 0.0;
    // With some 2.1 joints a grain the first half is 7.3 / 3.1 times the work of the second; 1.40 times the half of all.
    EXPECT_GT(before.unevenness(broken), 1.3);
    EXPECT_LT(before.unevenness(broken), 1.5);
    const BodyShare<2> after = share_of(partners, broken);
    EXPECT_DOUBLE_EQ(after.unevenness(broken), 1.0);
    EXPECT_EQ(after.grains().size() < before.grains().size(), partners.mine() == 0);
  });
}

TEST(SharedBody, MorePartnersThanGrainsAreNoTrouble)
{
  const auto pair = placed_specimen({1e-3, 1e-3}, {{{0.0, 2.01e-3}, {0.0, 0.0}}}); // which meet
  const auto after_some_steps = [](Dynamics<2>& dynamics) {
    for (int k = 0; k < 2000; ++k)
      dynamics.step();
    dynamics.know_all_motions();
    return dynamics.specimen().grains.velocity[0];
  };
  const auto set_off = [&] {
    Dynamics<2> dynamics(pair, {}, ZeroForce::at_touch);
    dynamics.push(0, {1.0, 0.0});
    return dynamics;
  };
  Dynamics<2> whole = set_off();
  const auto of_one = after_some_steps(whole);
  EXPECT_NE(of_one[1], 0.0) << "they have not met";
  ThreadPartners(4).run([&](Partners& partners) {
    Dynamics<2> part = set_off();
    part.share(partners);
    EXPECT_EQ(after_some_steps(part), of_one) << "partner " << partners.mine();
  });
}

TEST(SharedBody, BentBetweenPlatesThatPivotHasTheBitsOfOneProcess)
{
  const auto specimen = granite_box(0.020, 0.020);
  TestParameters wanted = quick();
  wanted.of<BendingParameters>().strain_rate = 0.5;
  wanted.of<BendingParameters>().sampling_strain = 1e-5;
  for (const LaboratoryCase& which : {LaboratoryCase{three_point_bending}, LaboratoryCase{semicircular_bending}})
    expect_the_bits_of_one_process(which, specimen, wanted, 2, 2, 20, 3);
}

TEST(SharedBody, UnderGravityAndTiltedHasTheBitsOfOneProcess)
{
  const auto specimen = granite_box(0.016, 0.010);
  TestParameters wanted = quick();
  wanted.gravity = {0.0, -9.81};
  wanted.platen_friction = 0.3;
  wanted.of<TiltParameters>().strain_rate = 200.0;
  wanted.stop_strain = 0.02;
  for (const LaboratoryCase& which : {LaboratoryCase{uniaxial_compression}, LaboratoryCase{tilt}})
    expect_same(alone<2>(which, specimen, wanted), led<2>(which, specimen, wanted, 2, 5, 3));
}

TEST(SharedBody, LedByItsLateralStrainHasTheBitsOfOneProcess)
{
  TestParameters wanted = quick();
  wanted.of<LoadingTable>().stages = {{.axial_stress = 40e6, .confining_pressure = 5e6},
                                      {.lateral_strain = -4e-4, .confining_pressure = 5e6},
                                      {.axial_strain = 6e-3, .confining_pressure = 10e6}};
  expect_the_bits_of_one_process<2>({own_loading}, small_specimen(), wanted, 20, 2, 20, 3);
}

TEST(SharedBody, RefusesByNameWhatIsNotSharedYet)
{
  Specimen<2> specimen = small_specimen();
  specimen.groups_are_rigid = true;
  specimen.groups.resize(specimen.grains.size());
  std::iota(specimen.groups.begin(), specimen.groups.end(), 0u);
  ThreadPartners(2).run([&](Partners& partners) {
    LabTest<2> test({uniaxial_compression}, specimen, quick(), {});
    EXPECT_EQ(tests::refusal([&] { test.share(partners); }),
              "a body of clumps cannot be computed by several processes together yet");
  });
}
} // namespace
} // namespace feldspar

// Clumps: the mass and the motion of rigid groups against closed forms, how groups are made, tests on specimens of them.

#include "base/input_error.h"
#include "dem/dynamics/dynamics.h"
#include "dem/flaws/clumps.h"
#include "dem/lab/laboratory_run.h"
#include "dem/lab/platens.h"
#include "dem/lab/protocols/protocols.h"
#include "dem/specimen/disjoint_sets.h"
#include "dem/specimen/fragments.h"
#include "dem/specimen/rigid_groups.h"
#include "dem/specimen/specimen_file.h"
#include "results/evaluation.h"
#include "tests/temporary_folder.h"
#include "tests/unit/same_bits.h"
#include "tests/unit/small_specimen.h"
#include "tests/unit/whole_tests.h"
#include "tests/words.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <map>
#include <numbers>
#include <set>

namespace feldspar
{
namespace
{
/// Grains that move in these groups.
Specimen<2> grouped(const std::vector<double>& radii, const Components<2>& positions,
                    const std::vector<std::uint32_t>& groups)
{
  Specimen<2> specimen = placed_specimen<2>(radii, positions);
  specimen.groups = groups;
  specimen.groups_are_rigid = true;
  specimen.report.n_clumps = std::set<std::uint32_t>(groups.begin(), groups.end()).size();
  return specimen;
}

double disc_mass(const double radius) { return 3000.0 * std::numbers::pi * radius * radius; }

/// Two unequal discs, one group: a dumb-bell along the first axis.
constexpr double radius_1 = 2e-3, radius_2 = 1e-3, span = 2.8e-3;
Specimen<2> dumb_bell() { return grouped({radius_1, radius_2}, {{{0.5, 0.5 + span}, {0.5, 0.5}}}, {0, 0}); }

TEST(RigidGroups, HaveTheMassCentreAndInertiaOfTheirMembers)
{
  const RigidGroups<2> groups(dumb_bell());
  ASSERT_EQ(groups.size(), 1u);
  const double m_1 = disc_mass(radius_1), m_2 = disc_mass(radius_2);
  EXPECT_DOUBLE_EQ(groups.bodies.mass[0], m_1 + m_2);
  EXPECT_NEAR(groups.bodies.position[0][0], 0.5 + m_2 / (m_1 + m_2) * span, 1e-15);
  EXPECT_NEAR(groups.bodies.position[1][0], 0.5, 1e-15);
  // ½ m R² of each, and the reduced mass at the span.
  const double inertia =
    0.5 * m_1 * radius_1 * radius_1 + 0.5 * m_2 * radius_2 * radius_2 + m_1 * m_2 / (m_1 + m_2) * span * span;
  EXPECT_NEAR(groups.bodies.moment_of_inertia[0], inertia, 1e-12 * inertia);
}

TEST(RigidGroups, FreeSpinAndFallAsOneBody)
{
  const Specimen<2> start = dumb_bell();
  Dynamics<2> dynamics(start, {0.0, 0.8}, ZeroForce::as_placed);
  dynamics.set_gravity({0.0, -9.81});
  // A push of one member across the way between them: M V = m v, I Ω = m v d.
  dynamics.push(1, {0.0, 2.0});
  const double m_1 = disc_mass(radius_1), m_2 = disc_mass(radius_2), m = m_1 + m_2;
  const double inertia =
    0.5 * m_1 * radius_1 * radius_1 + 0.5 * m_2 * radius_2 * radius_2 + m_1 * m_2 / m * span * span;
  const double velocity = m_2 / m * 2.0;
  const double spin = m_2 * 2.0 * (m_1 / m * span) / inertia;
  EXPECT_NEAR(dynamics.energies().kinetic, 0.5 * m * velocity * velocity + 0.5 * inertia * spin * spin, 1e-15);
  while (dynamics.time() < 0.01) // 6 radians and 2 mm
    dynamics.step();
  const double t = dynamics.time();
  ASSERT_GT(spin * t, 2.0);
  const auto& grains = dynamics.specimen().grains;
  const Vector<2> centre(0.5 + m_2 / m * span, 0.5 + velocity * t - 0.5 * 9.81 * t * t);
  const Vector<2> along(std::cos(spin * t), std::sin(spin * t));
  // Central differences are exact under a constant force; what is left is rounding over some thousand steps.
  EXPECT_LT((at<2>(grains.position, 0) - (centre - m_2 / m * span * along)).norm(), 1e-12);
  EXPECT_LT((at<2>(grains.position, 1) - (centre + m_1 / m * span * along)).norm(), 1e-12);
  EXPECT_NEAR(grains.spin[0][0], spin, 1e-12 * spin);
  EXPECT_NEAR(grains.spin[0][1], spin, 1e-12 * spin);
  const Energies energies = dynamics.energies();
  // Energy left open is that of theory.md §2.3 at the start, where the first kick is half a step: ¼ M g V Δt.
  const double half_kick = 0.25 * m * 9.81 * velocity * dynamics.time_step();
  EXPECT_NEAR(energies.unaccounted(), -half_kick, 1e-3 * half_kick);
  EXPECT_NEAR(energies.boundary_work, m * 9.81 * (0.5 - centre[1]), 1e-12 * m);
}

TEST(RigidGroups, CollideElasticallyAndKeepBothMomenta)
{
  // Two dumb-bells, the second flies past the end of the first, which hooks it out of its middle.
  Specimen<2> specimen = grouped({radius_1, radius_2, radius_2, radius_2},
                                 {{{0.5, 0.5 + span, 0.505, 0.5065}, {0.5, 0.5, 0.5024, 0.5024}}}, {0, 0, 1, 1});
  Dynamics<2> dynamics(specimen, {0.0, 0.05}, ZeroForce::as_placed);
  dynamics.push(2, {-0.5, 0.0});
  dynamics.push(3, {-0.5, 0.0});
  const auto momenta = [&] {
    const auto& g = dynamics.specimen().grains;
    Vector<3> sum = Vector<3>::Zero();
    for (std::uint32_t i = 0; i < g.size(); ++i)
      {
        const Vector<2> v = at<2>(g.velocity, i), x = at<2>(g.position, i);
        sum += Vector<3>(g.mass[i] * v[0], g.mass[i] * v[1],
                         g.mass[i] * (x[0] * v[1] - x[1] * v[0]) + g.moment_of_inertia[i] * g.spin[0][i]);
      }
    return sum;
  };
  dynamics.step();
  const Vector<3> before = momenta();
  const double put_in = dynamics.energies().kinetic;
  double most_stored = 0.0;
  while (dynamics.time() < 0.02)
    {
      dynamics.step();
      most_stored = std::max(most_stored, dynamics.energies().strain);
    }
  EXPECT_GT(most_stored, 0.1 * put_in) << "they have met";
  EXPECT_GT(std::abs(dynamics.specimen().grains.spin[0][0]), 1.0);
  EXPECT_NE(dynamics.specimen().grains.spin[0][0], dynamics.specimen().grains.spin[0][3]);
  const Vector<3> after = momenta();
  // Members have the velocity of their way, known to 1e-16 m over a step of 1e-8 s.
  EXPECT_LT((after - before).head<2>().norm(), 1e-6 * before.head<2>().norm());
  EXPECT_NEAR(after[2], before[2], 1e-6 * std::abs(before[2]));
  EXPECT_NEAR(dynamics.energies().kinetic, put_in, 0.005 * put_in);
  EXPECT_LT(std::abs(dynamics.energies().unaccounted()), 0.005 * put_in);
}

const Specimen<2>& packing(const std::uint64_t seed = 1)
{
  static std::map<std::uint64_t, Specimen<2>> known;
  if (const auto made = known.find(seed); made != known.end())
    return made->second;
  return known[seed] = granite_box(0.020, 0.040, ParallelBondParameters(), seed);
}

Specimen<2> clumped(const ClumpParameters& wanted, const std::uint64_t seed = 1)
{
  Specimen<2> specimen = packing(seed);
  put_in_clumps(specimen, wanted);
  return specimen;
}

TEST(Clumps, HaveNoJointInsideAndHangTogether)
{
  const Specimen<2>& loose = packing();
  for (const ClumpForm form : {ClumpForm::stamped, ClumpForm::cells})
    {
      const Specimen<2> specimen = clumped({0.005, form});
      const auto& joints = specimen.joints;
      EXPECT_TRUE(specimen.groups_are_rigid);
      ASSERT_EQ(specimen.groups.size(), specimen.grains.size());
      EXPECT_LT(specimen.report.n_clumps, specimen.grains.size() / 4);
      EXPECT_EQ(specimen.report.n_joints, joints.size());
      for (std::size_t j = 0; j < joints.size(); ++j)
        {
          EXPECT_NE(specimen.groups[joints.grain_1[j]], specimen.groups[joints.grain_2[j]]);
          EXPECT_EQ(joints.number[j], j);
        }
      // The joints that went lead from member to member through each whole group.
      DisjointSets sets(specimen.grains.size());
      std::size_t n_inside = 0;
      for (std::size_t j = 0; j < loose.joints.size(); ++j)
        if (specimen.groups[loose.joints.grain_1[j]] == specimen.groups[loose.joints.grain_2[j]])
          {
            sets.merge(loose.joints.grain_1[j], loose.joints.grain_2[j]);
            ++n_inside;
          }
      EXPECT_EQ(n_inside + joints.size(), loose.joints.size());
      std::set<std::uint32_t> roots;
      for (std::uint32_t i = 0; i < specimen.grains.size(); ++i)
        roots.insert(sets.root(i));
      EXPECT_EQ(roots.size(), specimen.report.n_clumps);
      // One stamp reaches its diameter at most, and the radii of two grains.
      if (form == ClumpForm::stamped)
        {
          for (std::uint32_t i = 0; i < specimen.grains.size(); ++i)
            for (std::uint32_t k = 0; k < i; ++k)
              if (specimen.groups[i] == specimen.groups[k])
                {
                  EXPECT_LT((at<2>(specimen.grains.position, i) - at<2>(specimen.grains.position, k)).norm(), 0.005);
                }
        }
      EXPECT_EQ(clumped({0.005, form}).groups, specimen.groups);
      EXPECT_NE(clumped({0.005, form}, 2).groups, specimen.groups);
      EXPECT_LT(clumped({0.008, form}).report.n_clumps, specimen.report.n_clumps);
    }
}

TEST(Clumps, ThatCannotBeAreRefused)
{
  Specimen<2> specimen = packing();
  EXPECT_THROW(put_in_clumps(specimen, {0.002}), InputError);
  Specimen<2> periodic = specimen;
  periodic.shape = BodyShape::periodic;
  EXPECT_THROW(put_in_clumps(periodic, {0.005}), InputError);
  Specimen<3> cylinder = small_cylinder();
  EXPECT_THROW(put_in_clumps(cylinder, {0.005}), InputError);
  put_in_clumps(specimen, {0.005});
  EXPECT_THROW(put_in_clumps(specimen, {0.005}), InputError);
}

TEST(Clumps, SwingOnTheirJointsWithoutLossAtTheirTimeStep)
{
  // Without damping, set off as if stretched at 0.05 1/s, which breaks nothing: a time step beyond the stable one would
  // let the motion grow without bounds, and a force that is lost between a group and its members would show.
  Dynamics<2> dynamics(clumped({0.005}), {0.0, 0.8}, ZeroForce::as_placed);
  start_steadily(dynamics, 0.05);
  const double put_in = dynamics.energies().kinetic;
  double most_stored = 0.0;
  std::size_t n_broken = 0;
  for (int k = 0; k < 4000; ++k)
    {
      n_broken += dynamics.step().size();
      most_stored = std::max(most_stored, dynamics.energies().strain);
    }
  EXPECT_EQ(n_broken, 0u);
  EXPECT_GT(most_stored, 0.5 * put_in);
  // The error of the time steps falls with their square: 1.1e-3 here, 2.8e-4 and 6.8e-5 at a half and a quarter of them.
  EXPECT_LT(std::abs(dynamics.energies().unaccounted()), 1.5e-3 * put_in);
}

TEST(Clumps, MeanStressIsThatOfThePlatens)
{
  const Specimen<2> specimen = clumped({0.005});
  SetUpTest<2> test{Dynamics<2>(specimen, {0.7, 0.8}, ZeroForce::as_placed), {}};
  const WallPair platens = add_platens(test, 0.0);
  Dynamics<2>& dynamics = test.dynamics;
  start_steadily(dynamics, -0.05);
  close(dynamics, platens, 0.05 * 0.040);
  while (dynamics.time() < 2e-3) // to a strain of 1e-4
    dynamics.step();
  const double platen_stress = -0.5 * (dynamics.wall_force(0) + dynamics.wall_force(1)) / 0.020;
  ASSERT_LT(platen_stress, -1e6);
  // Platens are smooth, and groups that balance have the stress that the platens put in: -(1/V) Σ f ⊗ x at the platens
  // is the force times the distance of the points where it acts, 0.1 % less than the height. The rest is the unbalanced
  // force, some 0.5 %.
  EXPECT_NEAR(dynamics.mean_stress()(1, 1), platen_stress, 0.01 * std::abs(platen_stress));
  EXPECT_NEAR(dynamics.mean_stress()(0, 0), 0.0, 0.01 * std::abs(platen_stress));
  EXPECT_NEAR(-dynamics.force_across(0.020) / 0.020, platen_stress, 0.01 * std::abs(platen_stress));
  // The stresses of the groups, by volume, make up the same.
  double sum = 0.0, volume = 0.0;
  const auto stresses = dynamics.grain_stresses();
  for (std::size_t i = 0; i < stresses.size(); ++i)
    {
      const double share = std::numbers::pi * std::pow(specimen.grains.radius[i], 2);
      sum += share * stresses[i](1, 1);
      volume += share;
    }
  EXPECT_NEAR(sum / volume, platen_stress, 0.01 * std::abs(platen_stress));
  EXPECT_EQ(stresses[0](1, 1),
            stresses[std::size_t(std::find(specimen.groups.begin() + 1, specimen.groups.end(), specimen.groups[0]) -
                                 specimen.groups.begin())](1, 1));
}

TEST(Clumps, CrackBetweenEachOtherAndTheEnergiesBalance)
{
  const Specimen<2> specimen = clumped({0.005});
  EXPECT_EQ(fragments(specimen)[0], fragments(packing())[0]) << "whole at first";
  for (const LaboratoryProtocol* protocol : {&uniaxial_compression, &direct_tension})
    {
      const auto outcome = tests::balanced_outcome_of<2>({*protocol}, specimen, quick_compression());
      ASSERT_EQ(outcome.record.failure, "");
      const auto results = evaluate(outcome.record);
      ASSERT_TRUE(results.peak_stress.value) << results.peak_stress.reason;
      EXPECT_GT(outcome.record.cracks.size(), 10u);
      // Members keep their distances.
      const auto& grains = outcome.appearance.grains_at_end;
      for (std::size_t i = 1; i < grains.size(); ++i)
        for (std::size_t k = 0; k < i; ++k)
          if (specimen.groups[i] == specimen.groups[k])
            {
              EXPECT_EQ(grains[i].fragment, grains[k].fragment);
              EXPECT_EQ(grains[i].group, grains[k].group);
              const double then =
                (at<2>(specimen.grains.position, std::uint32_t(i)) - at<2>(specimen.grains.position, std::uint32_t(k)))
                  .norm();
              const double now = std::hypot(grains[i].position[0] - grains[k].position[0],
                                            grains[i].position[1] - grains[k].position[1]);
              EXPECT_NEAR(now, then, 1e-12);
            }
    }
}

TEST(Clumps, GiveTheSameBitsWithOneThreadAndTwo)
{
  tests::expect_same_bits_on_two_threads(clumped({0.005}), quick_compression(), 50);
}

TEST(Clumps, ComeBackFromAFileAndATestTakenUpGivesTheSameBits)
{
  const tests::TemporaryFolder folder;
  const auto file = folder.path() / "specimen.h5";
  const Specimen<2> specimen = clumped({0.005});
  write_specimen(specimen, file);
  const auto back = read_specimen<2>(file);
  EXPECT_EQ(back.groups, specimen.groups);
  EXPECT_TRUE(back.groups_are_rigid);
  EXPECT_EQ(back.report.n_clumps, specimen.report.n_clumps);

  tests::expect_same_bits_when_resumed(specimen, back, quick_compression(), 30, 20);

  const auto is_refused = [&](const std::function<void(Specimen<2>&)>& spoil) {
    Specimen<2> wrong = specimen;
    spoil(wrong);
    write_specimen(wrong, file);
    return tests::refusal([&] { read_specimen<2>(file); }) != "";
  };
  EXPECT_FALSE(is_refused([](auto&) {}));
  EXPECT_TRUE(is_refused([](auto& wrong) { wrong.groups[0] = 1000000; }));
  EXPECT_TRUE(
    is_refused([](auto& wrong) { wrong.groups[wrong.joints.grain_1[0]] = wrong.groups[wrong.joints.grain_2[0]]; }));
  EXPECT_TRUE(is_refused([](auto& wrong) { wrong.report.n_clumps += 1; }));
}
} // namespace
} // namespace feldspar

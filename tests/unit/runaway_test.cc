#include "dem/dynamics/runaway.h"
#include "dem/flaws/clumps.h"
#include "dem/flaws/mineral_grains.h"
#include "dem/lab/laboratory_run.h"
#include "dem/lab/protocols/grips.h"
#include "dem/lab/protocols/protocols.h"
#include "laboratory/compression.h"
#include "tests/unit/small_specimen.h"
#include "tests/words.h"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <string>
#include <utility>

/// Numbers that go wrong are caught where they do.
namespace feldspar
{
namespace
{
using tests::has;

constexpr std::uint64_t most_steps_unseen = 10; // looks for contacts that may be missed are no farther apart

/// The words of the end of a pressed specimen to which something is done after some steps.
std::string end_after(const std::function<void(Grains<2>&)>& harm)
{
  Dynamics<2> dynamics(small_specimen(), {}, ZeroForce::as_placed);
  dynamics.add_wall({1, 1.0, 0.0, 0.0});
  dynamics.add_wall({1, -1.0, 0.020, -1e-3});
  for (int n = 0; n < 25; ++n)
    dynamics.step();
  harm(dynamics.specimen().grains);
  return tests::refusal<Runaway>([&] {
    for (std::uint64_t n = 0; n < most_steps_unseen + 1; ++n)
      dynamics.step();
  });
}

TEST(Runaway, IsToldByGrainStepAndReason)
{
  const double nan = std::numeric_limits<double>::quiet_NaN();
  EXPECT_EQ(end_after([](Grains<2>&) {}), "");
  for (const std::string& words :
       {end_after([&](Grains<2>& grains) { grains.velocity[0][7] = nan; }),
        end_after([&](Grains<2>& grains) { grains.spin[0][7] = nan; }),
        end_after([&](Grains<2>& grains) { grains.position[1][7] = 1e9; }),
        end_after([&](Grains<2>& grains) { grains.velocity[0][7] = std::numeric_limits<double>::infinity(); })})
    {
      EXPECT_EQ(words.find("numbers went wrong: grain "), 0u) << words;
      EXPECT_TRUE(has(words, " in step "));
      EXPECT_FALSE(has(words, "\n"));
    }
  // A grain in nobody's way is named itself.
  const std::string thrown = end_after([](Grains<2>& grains) { grains.velocity[0][7] = 1e9; });
  EXPECT_TRUE(has(thrown, "grain "));
  // A grain in free flight does its own radius in a step at 2 km/s and more, and is not disturbed below.
  EXPECT_EQ(end_after([](Grains<2>& grains) { grains.velocity[0][7] = 50.0; }), "");
}

TEST(Runaway, OfAGrainPressedThroughAPlaten)
{
  Dynamics<2> dynamics(small_specimen(), {}, ZeroForce::as_placed);
  const auto upper = dynamics.add_wall({1, -1.0, 0.020, 0.0});
  dynamics.step();
  dynamics.wall(upper).position -= 0.019;
  EXPECT_THROW(for (int n = 0; n < 100; ++n) dynamics.step(), Runaway);
}

// The face of a cut specimen may go through the middle of a grain.
TEST(Runaway, IsNoneWhereTheCentreOfAGrainComesALittleBehindAPlaten)
{
  const auto body = small_specimen();
  const double highest = *std::max_element(body.grains.position[1].begin(), body.grains.position[1].end());
  Dynamics<2> dynamics(body, {}, ZeroForce::as_placed);
  dynamics.add_wall({1, 1.0, 0.0, 0.0});
  const auto upper = dynamics.add_wall({1, -1.0, highest + 1e-9, 0.0});
  dynamics.step();
  dynamics.wall(upper).position -= 1e-7; // some ten-thousandth of a radius
  for (int n = 0; n < 100; ++n)
    ASSERT_NO_THROW(dynamics.step());
}

// The platen comes at a tenth of a millionth of a radius in a step, and nothing but soft contacts lets it through.
TEST(Runaway, OfSoftContactsAtAPlatenIsNotBlamedOnTheTimeStep)
{
  const Circumstances slow{1000, 1e-6, 0.99, 1e-4, 1e-3, true};
  EXPECT_TRUE(has(describe_runaway("grain 1 has been pressed through a wall", slow), "too soft for this load"));
  Circumstances fast = slow;
  fast.loading_speed = 1e2;
  EXPECT_TRUE(has(describe_runaway("grain 1 has been pressed through a wall", fast), "a lower rate"));
}

/// Rows, at most so many, and how it ended.
template <int dim>
TestOutcome run(LabTest<dim> test, const std::size_t most_rows)
{
  while (!test.has_ended() && test.curve().size() < most_rows)
    test.advance();
  return test.finish(!test.has_ended());
}

// Central differences are stable while ωΔt < 2; ω is at most some 1.2 of the root of stiffness over mass of the
// stiffest grain, by which the step is chosen. The largest safety allowed, 1, is thus stable even without damping.
TEST(Runaway, EndsATestWhoseTimeStepIsTooLongAndKeepsTheRowsBefore)
{
  const auto pressed_with = [](const double safety) {
    TestParameters parameters;
    parameters.of<CompressionParameters>().sampling_strain = 1e-6;
    return run(LabTest<2>({uniaxial_compression}, small_specimen(), parameters, {0.0, safety}), 200);
  };
  EXPECT_EQ(pressed_with(1.0).record.failure, "");
  for (const double safety : {2.0, 4.0})
    {
      const TestOutcome outcome = pressed_with(safety);
      const TestRecord& record = outcome.record;
      EXPECT_TRUE(record.interrupted);
      EXPECT_TRUE(has(record.failure, "grain", " in step ", "a smaller time_step_safety would help"));
      ASSERT_FALSE(record.curve.empty());
      EXPECT_LT(record.curve.back().energies.imbalance(), 1e-3);
      EXPECT_EQ(record.cracks.size(), record.curve.back().n_tension_cracks + record.curve.back().n_shear_cracks);
      ASSERT_FALSE(outcome.appearance.grains_at_end.empty());
      for (const GrainPicture& grain : outcome.appearance.grains_at_end)
        EXPECT_LT(std::abs(grain.position[0]) + std::abs(grain.position[1]), 0.1);
    }
}

/// A pressed specimen whose platens measure this stress from a step on.
template <std::uint64_t from_step>
SetUpTest<2> set_up_with_stress(const double stress, Specimen<2> specimen, const TestParameters& wanted,
                                const DynamicsParameters& dynamics)
{
  SetUpTest<2> set_up = (*uniaxial_compression.set_up<2>())(std::move(specimen), 0.0, wanted, dynamics);
  set_up.loading.end_stress = [stress, measured = set_up.loading.end_stress](const Dynamics<2>& body) {
    return body.n_steps() < from_step ? measured(body) : EndStress{stress, stress};
  };
  return set_up;
}

template <std::uint64_t from_step, bool is_infinite>
SetUpTest<2> wrong_set_up(Specimen<2> specimen, double, const TestParameters& wanted,
                          const DynamicsParameters& dynamics)
{
  using Limits = std::numeric_limits<double>;
  return set_up_with_stress<from_step>(is_infinite ? Limits::infinity() : Limits::quiet_NaN(), std::move(specimen),
                                       wanted, dynamics);
}

// Forces may overflow while all grains still stand right.
TEST(Runaway, LeavesNoRowWithoutFiniteNumbers)
{
  TestParameters parameters;
  parameters.of<CompressionParameters>().sampling_strain = 1e-6;
  constexpr std::uint64_t later = 100;
  const auto record_of = [&](const auto set_up) {
    LaboratoryProtocol protocol = uniaxial_compression;
    std::get<0>(protocol.set_ups) = set_up;
    return run(LabTest<2>({protocol}, small_specimen(), parameters, {}), 200).record;
  };
  for (const auto set_up : {&wrong_set_up<later, true>, &wrong_set_up<later, false>})
    {
      const TestRecord record = record_of(set_up);
      EXPECT_TRUE(has(record.failure, "numbers went wrong: axial_stress_Pa is not finite"));
      ASSERT_FALSE(record.curve.empty());
      EXPECT_LT(record.curve.back().step, later);
      EXPECT_EQ(not_finite_in(record.curve.back()), "");
    }
  for (const auto set_up : {&wrong_set_up<0, true>, &wrong_set_up<0, false>}) // from the first row on
    {
      const TestRecord record = record_of(set_up);
      EXPECT_TRUE(has(record.failure, "axial_stress_Pa is not finite"));
      EXPECT_TRUE(record.curve.empty());
    }
  // A gauge may have too few grains, and then no strain; an infinite one is wrong.
  CurveSample row;
  row.gauge_axial_strain = std::numeric_limits<double>::quiet_NaN();
  EXPECT_EQ(not_finite_in(row), "");
  row.gauge_axial_strain = std::numeric_limits<double>::infinity();
  EXPECT_EQ(not_finite_in(row), "gauge_axial_strain");
}

// Some 6e-8 s are a step of spheres of the granite; at 1e6 1/s they were strained by 0.06 in it.
TEST(Runaway, EndsATestThatIsStrainedPastBreakageInOneStep)
{
  const auto pulled_at = [](const double rate) {
    TestParameters parameters;
    parameters.of<TensionParameters>().strain_rate = rate;
    return run(LabTest<2>({direct_tension}, small_specimen(), parameters, {}), 3).record;
  };
  EXPECT_EQ(pulled_at(1e2).failure, "");
  const TestRecord record = pulled_at(1e6);
  EXPECT_TRUE(has(record.failure, "a lower strain rate is needed"));
  EXPECT_EQ(record.curve.size(), 1u);
  EXPECT_TRUE(has(pulled_at(1e300).failure, "a lower rate"));
}

TEST(Runaway, SeesEnergyThatGrowsWithoutWork)
{
  EnergyWatch watch;
  Energies energies;
  energies.boundary_work = 1.0;
  energies.strain = 0.9;
  energies.damping = 0.1;
  EXPECT_FALSE(watch.has_grown_without_work(energies));
  energies.boundary_work = 0.1; // unloaded, with a loss of nine tenths: what was once put in is the measure
  energies.strain = 0.0;
  energies.damping = 0.95;
  EXPECT_FALSE(watch.has_grown_without_work(energies));
  energies.damping = 1.2;
  EXPECT_TRUE(watch.has_grown_without_work(energies));
  energies.damping = std::numeric_limits<double>::quiet_NaN();
  EXPECT_TRUE(watch.has_grown_without_work(energies));
}

// The corners of what the input accepts. Steps are as many for each, by the rate; energies balance to some percent, for
// undamped joints that all break at once, and to the thousandth with damping.
TEST(Runaway, DoesNotSpeakUpInExtremesThatAreAccepted)
{
  for (const double stiffness_ratio : {1.0, 1e6})
    for (const double density : {1e-3, 1e6})
      for (const double damping : {0.0, 0.7})
        {
          SpecimenParameters wanted;
          wanted.width = 0.012;
          wanted.height = 0.020;
          wanted.bulk_density = density;
          FlatJointParameters flat_joint;
          flat_joint.coordination_number = 4.2;
          flat_joint.stiffness_ratio = stiffness_ratio;
          ParticleContactParameters contact;
          contact.stiffness_ratio = stiffness_ratio;
          const auto specimen = make_specimen<2>(wanted, flat_joint, contact, 1);
          TestParameters parameters;
          parameters.of<CompressionParameters>().strain_rate = 10.0 * std::sqrt(2700.0 / density);
          parameters.of<CompressionParameters>().sampling_strain = 1e-4;
          const auto outcome = run(LabTest<2>({uniaxial_compression}, specimen, parameters, {damping, 1.0}), 40);
          const std::string which = fmt::format("ratio {}, density {}, damping {}", stiffness_ratio, density, damping);
          EXPECT_EQ(outcome.record.failure, "") << which;
          EXPECT_LT(outcome.record.curve.back().energies.imbalance_over_work(), damping > 0.0 ? 0.01 : 0.1) << which;
        }
}

// The same corners for bodies of clumps, and for mineral grains whose boundaries are smooth joints without friction or with
// more than can slide, a thousand times stiffer across than along or the other way round. Bounds as above.
TEST(Runaway, DoesNotSpeakUpInExtremesOfClumpsAndSmoothJoints)
{
  for (const double friction : {0.0, 1e6})
    for (const double damping : {0.0, 0.7})
      {
        FlatJointParameters flat_joint;
        flat_joint.friction = friction;
        ParticleContactParameters contact;
        contact.friction = friction;
        const auto packed = granite_box(0.016, 0.024, flat_joint, 1, contact);
        TestParameters parameters;
        parameters.of<CompressionParameters>().sampling_strain = 2e-4;
        const auto holds = [&](Specimen<2> specimen, const double rate, const std::string& body) {
          parameters.of<CompressionParameters>().strain_rate = rate;
          const auto outcome = run(LabTest<2>({uniaxial_compression}, specimen, parameters, {damping, 1.0}), 40);
          const std::string which = fmt::format("{}, friction {}, damping {}", body, friction, damping);
          EXPECT_EQ(outcome.record.failure, "") << which;
          EXPECT_FALSE(outcome.record.cracks.empty()) << which;
          EXPECT_LT(outcome.record.curve.back().energies.imbalance_over_work(), damping > 0.0 ? 0.01 : 0.1) << which;
        };
        Specimen<2> clumped = packed;
        put_in_clumps(clumped, {4e-3});
        holds(clumped, 10.0, "clumps");
        for (const double stiffness_ratio : {1e-3, 1e3})
          {
            SmoothJointParameters boundary;
            boundary.shear_stiffness = boundary.normal_stiffness / stiffness_ratio;
            boundary.friction = friction;
            boundary.tensile_strength = 16e6;
            boundary.cohesion = 300e6;
            Specimen<2> mineral = packed;
            put_in_mineral_grains(mineral, {4e-3}, boundary);
            // Stiff shear has short steps: a faster test has no more of them than the others.
            holds(mineral, stiffness_ratio < 1.0 ? 100.0 : 10.0,
                  fmt::format("mineral grains of ratio {}", stiffness_ratio));
          }
      }
}
} // namespace
} // namespace feldspar

// A specimen that follows a table of stages.

#include "base/input_error.h"
#include "dem/lab/laboratory_run.h"
#include "dem/lab/protocols/protocols.h"
#include "laboratory/loading_stages.h"
#include "results/evaluation.h"
#include "tests/temporary_folder.h"
#include "tests/unit/small_specimen.h"
#include "tests/unit/staged_runs.h"
#include "tests/unit/taken_up.h"
#include "tests/unit/whole_tests.h"
#include "tests/words.h"

#include <fmt/format.h>
#include <gtest/gtest.h>
#include <oneapi/tbb/global_control.h>

#include <algorithm>
#include <cmath>

namespace feldspar::tests
{
namespace
{
constexpr double unbreakable = 1e3; // times the strength of the bonds

std::string error_of(const std::string& table)
{
  const TemporaryFolder folder;
  const std::string what = refusal([&] { read_loading_stages(folder.write("stages.csv", table)); });
  return what.substr(what.find("stages.csv"));
}

TEST(OwnLoading, OfAnElasticSpecimenReturnsOnItsLine)
{
  const auto record =
    run_stages<2>(small_specimen(1, unbreakable),
                  following({{.axial_strain = 1e-3}, {.axial_strain = 2e-4}, {.axial_strain = 1e-3}}));
  EXPECT_TRUE(record.cracks.empty());
  ASSERT_EQ(record.stages.size(), 3u);
  const auto stages = evaluate_stages(record);
  // A platen that turns round sends a wave of the stress E Δv/c: with Δv = 2 · ½ · 1/s · 20 mm and c = 4 km/s that is a
  // strain of 5e-6, on each side of the line.
  constexpr double wave = 5e-6;
  const double slope = *stages[0].slope.value;
  for (const auto& stage : stages)
    {
      ASSERT_TRUE(stage.slope.value);
      EXPECT_NEAR(*stage.slope.value, slope, 0.02 * slope);
    }
  EXPECT_NEAR(stages[1].strain_at_end, 2e-4, 1e-6);
  EXPECT_NEAR(stages[1].stress_at_end, stages[1].stress_at_start - slope * 8e-4, 4.0 * wave * slope);
  EXPECT_NEAR(stages[2].stress_at_end, stages[0].stress_at_end, 2.0 * wave * slope);
}

TEST(OwnLoading, HoldsWhatTheTableSays)
{
  // To an axial stress, then the confinement alone, then down to a lower stress.
  const auto record = run_stages<2>(small_specimen(1, unbreakable),
                                    following({{.axial_stress = 30e6, .confining_pressure = 5e6},
                                               {.axial_stress = 30e6, .duration = 4e-4, .confining_pressure = 15e6},
                                               {.axial_stress = 20e6, .confining_pressure = 15e6}}));
  ASSERT_EQ(record.stages.size(), 3u);
  const auto stages = evaluate_stages(record);
  EXPECT_TRUE(std::all_of(record.stages.begin(), record.stages.end(), [](const auto& stage) { return stage.reached; }));
  // The servo holds a pressure within 0.5 % at rest; walls that move are given 3 %.
  EXPECT_NEAR(stages[0].stress_at_start, 5e6, 0.03 * 5e6);
  EXPECT_NEAR(*stages[0].lateral_stress_at_end.value, 5e6, 0.03 * 5e6);
  EXPECT_NEAR(stages[0].stress_at_end, 30e6, 0.01 * 30e6);
  EXPECT_NEAR(*stages[1].lateral_stress_at_end.value, 15e6, 0.03 * 15e6);
  EXPECT_NEAR(stages[1].stress_at_end, 30e6, 0.03 * 30e6);
  EXPECT_NEAR(stages[1].duration, 4e-4, 1e-6);
  EXPECT_NEAR(stages[2].stress_at_end, 20e6, 0.01 * 20e6);
  EXPECT_NEAR(*stages[2].lateral_stress_at_end.value, 15e6, 0.03 * 15e6);
  // Half of the way through the hold the confinement is half of the way.
  const double middle =
    0.5 * (record.curve[record.stages[1].first_row].time + record.curve[record.stages[1].last_row].time);
  const auto row =
    std::find_if(record.curve.begin(), record.curve.end(), [=](const auto& one) { return one.time >= middle; });
  EXPECT_NEAR(-row->lateral_stress, 10e6, 0.05 * 10e6);
}

TEST(OwnLoading, LeavesAResidualStrainInABrokenSpecimen)
{
  // Well past the peak (some 8e-3 at this size) and back to the confinement, which keeps the pieces from springing back as a
  // column left between bare platens does. An elastic specimen is back at 0 but for the wave of the platens that turn, of
  // 1e-5 at 2/s; a residual strain is ten times that and more.
  const auto residual = [](const double strength, const double strain) {
    const auto record = run_stages<2>(
      small_specimen(1, strength), following({{.axial_strain = strain, .confining_pressure = 5e6, .strain_rate = 2.0},
                                              {.axial_stress = 5e6, .confining_pressure = 5e6, .strain_rate = 2.0}}));
    EXPECT_TRUE(record.stages.at(1).reached);
    return evaluate_stages(record).at(1);
  };
  const auto broken = residual(1.0, 1.5e-2);
  EXPECT_GT(broken.strain_at_end, 1e-4);
  EXPECT_LT(broken.strain_at_end, 1.5e-2);
  EXPECT_LT(std::abs(residual(unbreakable, 2e-3).strain_at_end), 1e-4);
}

TEST(OwnLoading, EndsInAStageThatTheSpecimenCannotBear)
{
  for (const double confinement : {0.0, 5e6})
    {
      const auto record = run_stages<2>(
        small_specimen(), following({{.axial_strain = 1e-3, .confining_pressure = confinement},
                                     {.axial_stress = 2e9, .confining_pressure = confinement, .strain_rate = 4.0},
                                     {.axial_strain = 0.0, .confining_pressure = confinement}}));
      ASSERT_EQ(record.stages.size(), 2u);
      EXPECT_TRUE(record.stages[0].reached);
      EXPECT_FALSE(record.stages[1].reached);
      const auto results = evaluate(record);
      ASSERT_TRUE(results.peak_stress.value) << results.peak_stress.reason;
      EXPECT_EQ(record.ended_early,
                fmt::format("stage 2 of 3, axial stress 2000 MPa: the stress rose to {:.1f} MPa and no "
                            "further",
                            *results.peak_stress.value / 1e6));
      // The end follows from the rule of other tests: at 1.6 times the strain at the peak, or before.
      EXPECT_LT(-record.curve.back().axial_strain, 1.6 * *results.strain_at_peak.value + 2e-5);
      for (const Figure& figure :
           {results.youngs_modulus_initial, results.crack_initiation_stress, results.post_peak_drop})
        EXPECT_EQ(figure.reason, "the curve goes back and forth; each stage has a slope of its own");
    }
}

TEST(OwnLoading, KeepsTheRateOfTheLateralStrain)
{
  // The specimen does not break. The platens are moved by the strain that is missed, and close at the rate over
  // Poisson's ratio; at 0.3 c/H = 8e4/s and 1/s to 2.5/s that strain is up to 3e-5. Waves of the start add to it.
  const auto record =
    run_stages<2>(small_specimen(1, unbreakable), following({{.lateral_strain = -8e-4, .strain_rate = 0.25}}));
  EXPECT_TRUE(record.cracks.empty());
  EXPECT_TRUE(record.stages.at(0).reached);
  for (const CurveSample& row : record.curve)
    EXPECT_NEAR(row.gauge_lateral_strain, 0.25 * row.time, 5e-5);
}

TEST(OwnLoading, EndsWhereTheLateralStrainCannotBeLed)
{
  // Poisson's ratio of 0.1 and more has widened the specimen by 4e-4 at least.
  const auto narrow =
    run_stages<2>(small_specimen(1, unbreakable),
                  following({{.axial_strain = 4e-3}, {.lateral_strain = -1e-4, .strain_rate = 0.25}}));
  EXPECT_FALSE(narrow.stages.at(1).reached);
  const std::string reason =
    "stage 2 of 2, lateral strain -0.0001: the specimen was as wide before it, at a lateral strain of ";
  EXPECT_EQ(narrow.ended_early.substr(0, reason.size()), reason);
  // Platens that close at no more than 0.3 c/H · 1e-4 cannot keep 100/s.
  const auto fast =
    run_stages<2>(small_specimen(1, unbreakable), following({{.lateral_strain = -2e-3, .strain_rate = 100.0}}));
  EXPECT_FALSE(fast.stages.at(0).reached);
  EXPECT_TRUE(fast.ended_early.ends_with(" in 3 times as long as its rate takes")) << fast.ended_early;
  auto small = following({{.lateral_strain = -1e-2, .strain_rate = 0.25}});
  small.stop_strain = 1e-3;
  EXPECT_EQ(run_stages<2>(small_specimen(), small).ended_early,
            "stage 1 of 1, lateral strain -0.01: not reached at an axial strain of 0.001, where the test stops");
}

TEST(OwnLoading, RefusesALateralStrainThatTheGaugeCannotTell)
{
  // A grain without a joint does not count to the gauge.
  const auto loose = placed_specimen({0.25, 0.25}, {{{0.25, 0.75}, {0.25, 0.75}}});
  const auto start = [&](const LoadingStage& stage) {
    LabTest<2> test({own_loading}, loose, following({stage}), {});
    test.advance();
  };
  EXPECT_THROW(start({.lateral_strain = -1e-3, .strain_rate = 0.2}), InputError);
  EXPECT_NO_THROW(start({.axial_strain = 1e-3}));
}

TEST(OwnLoading, LedByTheLateralStrainIsTakenUpAgainToTheSameBitsWithAnotherNumberOfThreads)
{
  const TemporaryFolder folder;
  const auto file = folder.path() / "checkpoint.h5";
  const auto specimen = small_specimen();
  const auto wanted = led_by_lateral_strain(0.007, 5e6);
  LabTest<2> whole({own_loading}, specimen, wanted, {});
  const auto has_peaked = [](const LabTest<2>& test) { return test.curve().back().gauge_lateral_strain > 6e-3; };
  const auto limit_threads = [](const std::size_t n) {
    return oneapi::tbb::global_control(oneapi::tbb::global_control::max_allowed_parallelism, n);
  };
  {
    const auto limit = limit_threads(1);
    do
      ASSERT_TRUE(whole.advance());
    while (!has_peaked(whole));
    whole.write_checkpoint(file, "a test");
    while (whole.advance())
      ;
  }
  const auto limit = limit_threads(2);
  LabTest<2> part({own_loading}, specimen, wanted, {});
  part.read_checkpoint(file, "a test");
  while (part.advance())
    ;
  ASSERT_EQ(part.curve().size(), whole.curve().size());
  EXPECT_EQ(part.n_steps(), whole.n_steps());
  EXPECT_EQ(part.curve().back().axial_strain, whole.curve().back().axial_strain);
  EXPECT_EQ(part.curve().back().axial_stress, whole.curve().back().axial_stress);
}

TEST(OwnLoading, IsTakenUpAgainInTheMiddleOfAStageToTheSameBits)
{
  const TemporaryFolder folder;
  const auto file = folder.path() / "checkpoint.h5";
  const auto specimen = small_specimen(1, unbreakable);
  const auto wanted = following({{.axial_strain = 3e-4}, {.axial_stress = 2e6}, {.axial_strain = 2e-4}});
  auto [whole, part] = whole_and_taken_up([&] { return LabTest<2>({own_loading}, specimen, wanted, {}); });
  ASSERT_EQ(part.curve().size(), whole.curve().size());
  part.write_checkpoint(file, "a test");
  EXPECT_EQ(part.curve().back().axial_stress, whole.curve().back().axial_stress);
  const auto of_part = part.finish(false).record.stages;
  const auto of_whole = whole.finish(false).record.stages;
  ASSERT_EQ(of_part.size(), 3u);
  for (std::size_t k = 0; k < 3; ++k)
    EXPECT_EQ(of_part[k].last_row, of_whole[k].last_row);

  LabTest<2> other({own_loading}, specimen, following({{.axial_strain = 4e-4}}), {});
  EXPECT_THROW(other.read_checkpoint(file, "a test"), InputError);
}

TEST(OwnLoading, KeepsAsManyStatesAsAreWantedAndTheEnd)
{
  auto wanted = following({{.axial_strain = 3e-4}}); // thirty rows after the first
  const auto specimen = small_specimen(1, unbreakable);
  for (const unsigned int n : {2u, 5u, 32u, 1000u})
    {
      wanted.n_snapshots = n;
      const auto outcome = outcome_of<2>({own_loading}, specimen, wanted);
      const auto& kept = outcome.appearance.snapshots;
      EXPECT_LE(kept.size(), n);
      EXPECT_GE(2 * kept.size(), std::min<std::size_t>(n, outcome.record.curve.size()));
      EXPECT_EQ(kept.front().step, outcome.record.curve.front().step);
      EXPECT_EQ(kept.back().step, outcome.record.curve.back().step);
    }
}

TEST(TestParameters, KeepFewerStatesOfALargeBody)
{
  const TestParameters wanted; // 32 states
  EXPECT_EQ(wanted.snapshots_of(100'000), 32u);
  EXPECT_EQ(wanted.snapshots_of(200'000), 16u);
  EXPECT_EQ(wanted.snapshots_of(10'000'000), 4u);
  TestParameters few;
  few.n_snapshots = 2;
  EXPECT_EQ(few.snapshots_of(10'000'000), 2u);
}

TEST(OwnLoading, OfACylinderFollowsItsTableToo)
{
  const auto record = run_stages<3>(small_cylinder(1, unbreakable),
                                    following({{.axial_strain = 4e-4, .confining_pressure = 5e6, .strain_rate = 4.0},
                                               {.axial_stress = 8e6, .confining_pressure = 5e6, .strain_rate = 4.0}}));
  const auto stages = evaluate_stages(record);
  ASSERT_EQ(stages.size(), 2u);
  EXPECT_NEAR(*stages[1].lateral_stress_at_end.value, 5e6, 0.05 * 5e6);
  EXPECT_NEAR(stages[1].stress_at_end, 8e6, 0.05 * 8e6);
}

TEST(LoadingTable, KeepsTheConfinementOfTheRowAboveWhereACellIsEmpty)
{
  const TemporaryFolder folder;
  const auto stages = read_loading_stages(folder.write(
    "stages.csv", "axial_strain,axial_stress_Pa,hold_s,confining_pressure_Pa\n1e-3,,,5e6\n,20e6,1e-4,\n,8e6,,\n"));
  ASSERT_EQ(stages.size(), 3u);
  EXPECT_EQ(stages[2].confining_pressure, 5e6);
  EXPECT_EQ(stages[1].duration, 1e-4);
  EXPECT_EQ(words(stages[1]), "hold of 0.0001 s at axial stress 20 MPa");
  EXPECT_FALSE(stages[2].duration);
}

TEST(LoadingTable, IsRefusedByStageAndReason)
{
  EXPECT_EQ(error_of("axial_strain,speed\n1e-3,2\n"),
            "stages.csv:1: \"speed\" is no column of a loading table; they are axial_strain, axial_stress_Pa, hold_s, "
            "confining_pressure_Pa, strain_rate_per_s, lateral_strain, or have their unit in brackets, as in "
            "\"axial_stress [MPa]\"");
  const std::string header = "axial_strain,axial_stress_Pa,hold_s,confining_pressure_Pa,strain_rate_per_s\n";
  EXPECT_EQ(error_of(header), "stages.csv: there is no stage below the header");
  EXPECT_EQ(error_of(header + "1e-3,,,,\n1e-3,2e6,,,\n"),
            "stages.csv:3: stage 2: axial_strain and axial_stress_Pa are both given; a stage ends at one of them");
  EXPECT_EQ(error_of(header + ",60,,,\n"),
            "stages.csv:2: stage 1: axial_stress_Pa = 60 is less than 1 kPa; stresses of "
            "the table are in Pa, 60 MPa is 60e6");
  EXPECT_EQ(
    error_of(header + ",1e300,,,\n"),
    "stages.csv:2: stage 1: axial_stress_Pa = 1e+300 is more than 100 GPa; stresses of the table are in Pa, 60 MPa "
    "is 60e6");
  EXPECT_EQ(error_of(header + "1e-3,,,1e12,\n").substr(0, 53), "stages.csv:2: stage 1: confining_pressure_Pa = 1e+12 ");
  EXPECT_EQ(error_of(header + ",1e6,1e300,,\n"), "stages.csv:2: stage 1: hold_s = 1e+300: must lie in (0, 1e+06]");
  EXPECT_EQ(error_of(header + ",1e6,0,,\n"), "stages.csv:2: stage 1: hold_s = 0: must lie in (0, 1e+06]");
  EXPECT_EQ(error_of(header + "1e-3,,,5,\n").substr(0, 49), "stages.csv:2: stage 1: confining_pressure_Pa = 5 ");
  EXPECT_EQ(error_of(header + ",,,5e6,\n"),
            "stages.csv:2: stage 1: has no target; give axial_strain, axial_stress_Pa, hold_s or lateral_strain");
  EXPECT_EQ(error_of(header + "-1e-3,,,,\n"),
            "stages.csv:2: stage 1: axial_strain = -0.001: must lie in [0, 0.2]; compression is positive");
  EXPECT_EQ(
    error_of(header + "1e-3,,,,\n2e-3,,,5e6,\n"),
    "stages.csv:3: stage 2: confining_pressure_Pa is 0 in some stages and not in others; a wall that presses on "
    "nothing cannot be held");
  EXPECT_EQ(
    error_of(header + ",9e6,,5e6,\n,20e6,,7e6,\n"),
    "stages.csv:3: stage 2: changes confining_pressure_Pa on the way to an axial stress; change it in a hold or on "
    "the way to a strain");
  EXPECT_EQ(error_of(header + "1e-3,,,,0\n"),
            "stages.csv:2: stage 1: strain_rate_per_s = 0: must be above 0; the target gives the direction");
  const std::string led = "lateral_strain,axial_strain,strain_rate_per_s\n";
  EXPECT_EQ(error_of(led + "0.002,,0.2\n"),
            "stages.csv:2: stage 1: lateral_strain = 0.002: must lie in [-0.2, 0); compression is positive, a specimen "
            "that widens has a negative one");
  EXPECT_EQ(
    error_of(led + "-0.002,0.01,0.2\n"),
    "stages.csv:2: stage 1: lateral_strain and another target are both given; a stage led by the lateral strain "
    "ends at it");
  EXPECT_EQ(
    error_of(led + "-0.002,,\n"),
    "stages.csv:2: stage 1: lateral_strain needs strain_rate_per_s, of itself; at a fifth of an axial rate most "
    "rock is shortened as fast at first");
  EXPECT_EQ(
    error_of(led + "-0.002,,0.2\n-0.001,,0.2\n"),
    "stages.csv:3: stage 2: lateral_strain = -0.001: must be below -0.002 of the stage before; a broken specimen "
    "does not narrow");
  // The line is that of the file, the stage that of the specimen: empty lines are no stages.
  EXPECT_EQ(error_of(header + "\n\n1e-3,,,,0\n").substr(0, 23), "stages.csv:4: stage 1: ");
  EXPECT_EQ(error_of(header + "1e-3,,,,fast\n").substr(0, 13), "stages.csv:2:");
}
} // namespace
} // namespace feldspar::tests

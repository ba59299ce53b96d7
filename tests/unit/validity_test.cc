// Names of results, choice of those that count, and sentences on a study: no figure stands for one that was not
// measured.

#include "dem/lab/protocols/protocols.h"
#include "report/pictures/figures.h"
#include "report/pictures/maps/specimen_data.h"
#include "report/sections/comparison.h"
#include "results/fits/run_envelopes.h"
#include "results/folder/provenance_json.h"
#include "results/folder/result_folder.h"
#include "results/runs/repeats.h"
#include "results/runs/trust.h"
#include "tests/content.h"
#include "tests/temporary_folder.h"
#include "tests/words.h"

#include <fmt/format.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <string>
#include <vector>

namespace feldspar::tests
{
namespace
{
/// A test that rises to a strength [Pa] within ten rows and falls to a fifth of it; a crack at the end of each row.
FinishedTest made(const TestKind& kind, const double strength, const std::uint64_t seed = 1,
                  const double confining_pressure = 0.0)
{
  FinishedTest test;
  test.group = name(TestCase{kind, confining_pressure});
  test.name = fmt::format("{}_seed_{}", test.group, seed);
  test.record.kind = kind;
  test.record.seed = seed;
  test.record.confining_pressure = confining_pressure;
  test.record.has_servo = confining_pressure > 0.0;
  test.record.size = {0.02, 0.04, 0.0};
  test.record.bulk_density = 2700.0;
  test.record.specimen.n_grains = 100;
  test.record.specimen.resolution = 20.0; // grains of 1 mm
  for (int k = 0; k <= 14; ++k)
    {
      CurveSample row;
      row.step = std::uint64_t(100 * k);
      row.axial_strain = row.gauge_axial_strain = kind.sign * 1e-4 * k;
      const double share = k <= 10 ? 0.1 * k : 1.0 - 0.2 * (k - 10);
      row.axial_stress = kind.sign * (confining_pressure + share * (strength - confining_pressure));
      row.lateral_stress = -confining_pressure;
      row.energies = {1.0 * k, 1e-5 * k, 1.0 * k, 0.0, 0.0, 0.0};
      test.record.curve.push_back(row);
    }
  test.appearance.grains_at_end = {{{0.005, 0.005, 0.0}, {0.005, 0.005, 0.0}, 0.0005, 0}};
  test.results = evaluate(test.record);
  return test;
}

/// A disc of 30 mm, in space 10 mm long, with a crack at each height over its middle [m], one each twenty steps.
FinishedTest split(const std::vector<double>& heights, const double strength, const std::uint64_t seed,
                   const int dimension = 2)
{
  FinishedTest test = made(brazilian.kind, strength, seed);
  test.record.size = dimension == 2 ? std::array{0.03, 0.03, 0.0} : std::array{0.03, 0.01, 0.03};
  const auto axis = std::size_t(dimension) - 1;
  for (const double height : heights)
    {
      Crack crack{};
      crack.step = 20 * (1 + test.record.cracks.size());
      crack.centroid = {0.015, 0.005, 0.0};
      crack.centroid[axis] = 0.015 + height;
      test.record.cracks.push_back(crack);
    }
  test.results = evaluate(test.record);
  return test;
}

std::string said_of(const std::vector<FinishedTest>& tests)
{
  return joined(warnings({"rock", SeriesKind::specimens, {}, tests, {}}));
}

const ComparisonRow* row_of(const std::vector<ComparisonRow>& rows, const std::string& property)
{
  const auto found =
    std::find_if(rows.begin(), rows.end(), [&](const ComparisonRow& row) { return row.property == property; });
  return found == rows.end() ? nullptr : &*found;
}

// Hondros' stress across the loaded diameter of a disc loaded over 20° at either end, at r/R = ρ, with α = 10°, is
// proportional to (1 - ρ²) sin 2α/(1 - 2ρ² cos 2α + ρ⁴) - atan((1 + ρ²)/(1 - ρ²) tan α): half of that in the middle at 0.68.
TEST(SplittingTest, PullsTheDiscUpToTwoThirdsOfItsRadius)
{
  const double alpha = 10.0 * std::numbers::pi / 180.0;
  const auto across = [&](const double rho) {
    const double square = rho * rho;
    return (1.0 - square) * std::sin(2.0 * alpha) / (1.0 - 2.0 * square * std::cos(2.0 * alpha) + square * square) -
           std::atan((1.0 + square) / (1.0 - square) * std::tan(alpha));
  };
  EXPECT_GT(across(0.68), 0.5 * across(0.0));
  EXPECT_LT(across(0.69), 0.5 * across(0.0));
  EXPECT_LT(across(0.77), 0.0);
  // A crack at 10.1 of 15 mm lies in the part that is pulled, one at 10.3 mm does not.
  EXPECT_EQ(*split({0.0101}, 9e6, 1).results.first_cracks_at_pads_share.value, 0.0);
  EXPECT_EQ(*split({-0.0103}, 9e6, 1).results.first_cracks_at_pads_share.value, 1.0);
}

TEST(SplittingTest, ThatBreaksAtItsPadsIsNotValidAndCountsNowhere)
{
  for (const int dimension : {2, 3})
    {
      const std::vector<double> in_the_middle{0.001, -0.002, 0.004, 0.0, 0.013, -0.006, 0.002, 0.001, 0.0, 0.003};
      const std::vector<double> at_the_pad{-0.014, -0.014, 0.001, -0.014, -0.0135, -0.014, 0.0, -0.013, 0.0, 0.001};
      const std::vector<FinishedTest> tests{split(in_the_middle, 10e6, 1, dimension),
                                            split(at_the_pad, 5.3e6, 2, dimension)};
      EXPECT_EQ(*tests[0].results.first_cracks_at_pads_share.value, 0.125); // of the first eight
      EXPECT_EQ(*tests[1].results.first_cracks_at_pads_share.value, 0.75);
      EXPECT_TRUE(tests[0].counts());
      EXPECT_FALSE(tests[1].counts());
      EXPECT_EQ(*tests[1].results.peak_stress.value, 5.3e6); // it is reported none the less
      EXPECT_EQ(*strength_data(tests).tensile_strength, 10e6);
      const auto rows = compare(tests, std::nullopt);
      const ComparisonRow* const strength = row_of(rows, "Brazilian tensile strength");
      ASSERT_TRUE(strength);
      EXPECT_EQ(strength->ours->n, 1u);
      EXPECT_EQ(strength->ours->mean, 10.0);
      const std::string said = said_of(tests);
      EXPECT_TRUE(
        has(said,
            "brazilian_seed_2, 5.30 MPa, is not valid as a splitting test: 75 % of its first cracks lie at the "
            "pads",
            "Its figures enter no mean, envelope or calibration.", "ISRM 1978, ASTM D3967"));
      EXPECT_FALSE(has(said, "brazilian_seed_1, "));

      const TemporaryFolder folder;
      write_result_folder({}, tests, fit_each_rock(tests), folder.path());
      const auto summary = nlohmann::json::parse(content(folder.path() / "summary.json"));
      EXPECT_EQ(summary["ensemble"]["brazilian"]["n_made"], 2);
      EXPECT_EQ(summary["ensemble"]["brazilian"]["n_valid"], 1);
      EXPECT_EQ(summary["ensemble"]["brazilian"]["peak_stress_Pa"]["mean"], 10e6);
      EXPECT_FALSE(read_result_folder(folder.path(), test_kinds())[0].tests[1].results.is_valid());
    }
}

// The strength is the stress of row 10, at step 1000: of 110 cracks, one each 20 steps, 50 are there, and 16 are the
// first third of them. Later cracks do not make a disc that was split one that was crushed.
TEST(SplittingTest, IsJudgedByTheFirstThirdOfTheCracksUpToItsPeak)
{
  std::vector<double> heights(15, 0.002);
  heights.insert(heights.end(), 95, 0.0145);
  EXPECT_EQ(*split(heights, 9e6, 1).results.first_cracks_at_pads_share.value, 1.0 / 16.0);
  // A disc without a crack gives no such figure, and other tests neither.
  EXPECT_EQ(split({}, 9e6, 1).results.first_cracks_at_pads_share.reason, "no crack");
  EXPECT_EQ(made(direct_tension.kind, 9e6).results.first_cracks_at_pads_share.reason, "the test splits no disc");
  EXPECT_TRUE(made(direct_tension.kind, 9e6).counts());
}

TEST(BodyWithFlaws, HasHighestNominalStressesAndNoStrengths)
{
  std::vector<FinishedTest> tests{made(direct_tension.kind, 4.02e6), made(uniaxial_compression.kind, 60e6),
                                  made(triaxial_compression.kind, 110e6, 1, 10e6), made(brazilian.kind, 5e6)};
  const auto properties = [&] {
    std::string names;
    for (const auto& row : compare(tests, std::nullopt))
      if (row.ours)
        names += row.property + "\n";
    return names;
  };
  const std::string intact = properties();
  EXPECT_TRUE(has(intact, "tensile strength\n", "uniaxial compressive strength\n", "strength at 10 MPa confinement\n",
                  "Brazilian tensile strength\n"));
  EXPECT_FALSE(has(said_of(tests), "nominal"));

  for (FinishedTest& test : tests)
    test.appearance.flaws = {{"slot", true, {{0.005, 0.02, 0.0}, {0.015, 0.02, 0.0}}}};
  const std::string flawed = properties();
  EXPECT_TRUE(has(flawed, "Direct tension, highest nominal stress\n", "Uniaxial compression, highest nominal stress\n",
                  "Triaxial compression, highest nominal stress at 10 MPa confinement\n",
                  "Brazilian test, highest nominal stress\n", "highest nominal stresses, tension over compression\n"));
  EXPECT_FALSE(has(flawed, "strength"));
  EXPECT_TRUE(has(said_of(tests), "They are no strengths of the rock, nor is their envelope."));
  const auto envelopes = fit_strength_envelopes(strength_data(tests));
  EXPECT_TRUE(envelopes.data.of_flawed_body);
  EXPECT_TRUE(as_text(envelopes).starts_with("Envelopes of highest nominal stresses:")) << as_text(envelopes);
  EXPECT_TRUE(remark(envelopes).starts_with("The points are highest nominal stresses of a body with flaws"));
  // The keys of files stay; a notched body has its own name already.
  EXPECT_EQ(row_of(compare(tests, std::nullopt), "Direct tension, highest nominal stress")->key,
            "tensile_strength_MPa");
  // An intact body beside it is named alike, so that both stand in one row.
  const auto beside = compare({made(direct_tension.kind, 9e6)}, std::nullopt, {}, true);
  EXPECT_EQ(row_of(beside, "Direct tension, highest nominal stress")->ours->mean, 9.0);
  tests = {made(centre_cracked_plate.kind, 4e6)};
  tests[0].appearance.flaws = {{"hole", true, {}}};
  EXPECT_TRUE(has(properties(), "tensile strength, cracked\n"));
}

// A plate holds σ_3 H, which meets the plane over W tan β of the height (docs/theory.md §3.1).
TEST(PlaneThroughABody, BetweenRigidSidePlatesIsSaidToBeTooStrong)
{
  const auto with_plane = [](const double angle, const double from, const double to, const TestKind& kind,
                             const double pressure) {
    std::vector<FinishedTest> tests;
    for (const std::uint64_t seed : {1, 2, 3})
      {
        tests.push_back(made(kind, 100e6, seed, pressure));
        const auto at = [&](const double x) {
          return std::array{x, 0.02 + (x - 0.01) * std::tan(angle * std::numbers::pi / 180.0), 0.0};
        };
        tests.back().appearance.flaws = {{"closed flaw", false, {at(from), at(0.01), at(to)}}};
      }
    return said_of(tests);
  };
  // 20 x 40 mm: 2/tan 54.25° = 1.44.
  const std::string steep = with_plane(54.25, 0.0, 0.02, triaxial_compression.kind, 10e6);
  EXPECT_TRUE(has(steep, "A closed flaw crosses the body from side to side at 54 deg to the platens.",
                  "the deviator is that of 1.44 times the confining pressure, 44 % too high"));
  EXPECT_EQ(times(steep, "crosses the body"), 1u); // once for the rock
  // 2/tan 45° = 2; downwards as well.
  EXPECT_TRUE(has(with_plane(-45.0, 0.0, 0.02, triaxial_compression.kind, 10e6), "that of 2.00 times"));
  // From corner to corner the formula holds; a plane that ends inside, one that does not slide, and free sides: nothing.
  for (const std::string& said :
       {with_plane(std::atan(2.0) * 180.0 / std::numbers::pi, 0.0, 0.02, triaxial_compression.kind, 10e6),
        with_plane(54.25, 0.0, 0.015, triaxial_compression.kind, 10e6),
        with_plane(5.0, 0.0, 0.02, triaxial_compression.kind, 10e6),
        with_plane(54.25, 0.0, 0.02, uniaxial_compression.kind, 0.0)})
    EXPECT_FALSE(has(said, "crosses the body"));
}

/// A variant of a study with one test of this strength.
FinishedTest variant(const std::vector<VariantSetting>& settings, const double strength)
{
  FinishedTest test = made(uniaxial_compression.kind, strength);
  test.settings = settings;
  for (const VariantSetting& setting : settings)
    test.variant += setting.entry + " = " + setting.value + "; ";
  return test;
}

std::string repeats_of(const std::vector<FinishedTest>& tests)
{
  std::vector<const FinishedTest*> all;
  for (const auto& test : tests)
    all.push_back(&test);
  return joined(remarks_on_repeats(all));
}

TEST(Study, NamesAnEntryWithoutEffect)
{
  // Two laws, five gaps, five friction angles: with the second law the angle has no effect.
  std::vector<FinishedTest> tests;
  for (const bool second : {false, true})
    for (int gap = 1; gap <= 5; ++gap)
      for (int angle = 1; angle <= 5; ++angle)
        {
          tests.push_back(variant({{"Specimen/Joint law", second ? "b" : "a"},
                                   {"Flat joint/Installation gap ratio", fmt::format("0.0{}", gap)},
                                   {"Flat joint/Bond friction angle", fmt::format("{} deg", angle)}},
                                  1e6 * (50 + 5 * gap + (second ? 30.5 : 0.37 * angle))));
          tests.back().bookkeeping.wall_time = 1.0 * angle; // which repeats nothing
        }
  EXPECT_EQ(
    repeats_of(tests),
    "20 of 50 variants repeat the results of 5 others to ten digits. They differ in Flat joint/Bond friction angle "
    "alone, and all have Specimen/Joint law = b: this entry has no effect there\n");
  // In the eleventh digit alone is the same; in the ninth another.
  tests = {variant({{"Tests/Snapshots", "2"}}, 80e6), variant({{"Tests/Snapshots", "5"}}, 80e6 * (1.0 + 1e-12))};
  EXPECT_EQ(repeats_of(tests), "1 of 2 variants repeats the results of 1 other to ten digits. They differ in "
                               "Tests/Snapshots alone: this entry has no effect in this study\n");
  tests[1] = variant({{"Tests/Snapshots", "5"}}, 80e6 * (1.0 + 1e-8));
  EXPECT_EQ(repeats_of(tests), "");
  // Without variants, or where a test could not be made, nothing is said.
  EXPECT_EQ(repeats_of({made(uniaxial_compression.kind, 80e6), made(uniaxial_compression.kind, 80e6)}), "");
  tests[1] = tests[0];
  tests[1].variant = "another";
  tests[1].settings[0].value = "7";
  tests[1].record.failure = tests[0].record.failure = "the grips slipped";
  EXPECT_EQ(repeats_of(tests), "");
}

TEST(Study, OfTwoEntriesHasAMap)
{
  std::vector<Series> all;
  const auto add = [&](const std::string& gap, const std::string& strength, const double result) {
    all.push_back(
      {gap + strength,
       SeriesKind::specimens,
       {},
       {variant({{"Flat joint/Installation gap ratio", gap}, {"Flat joint/Bond tensile strength", strength}}, result)},
       {}});
  };
  const auto map_of_strength = [&] {
    const auto pictures = study_pictures(all);
    const auto found = std::find_if(pictures.begin(), pictures.end(), [](const Picture& picture) {
      return picture.name == "study_map_Flat_joint_Bond_tensile_strength_Flat_joint_Installation_gap_ratio_strength_"
                             "uniaxial_compression";
    });
    return found == pictures.end() ? ChartSeries() : found->panels.front().series.front();
  };
  for (const auto& [gap, of_gap] : {std::pair("0.02", 10e6), {"0.05", 20e6}, {"0.1", 30e6}})
    for (const auto& [strength, of_strength] : {std::pair("10 MPa", 50e6), {"20 MPa", 100e6}})
      add(gap, strength, of_gap + of_strength);
  // Fields reach halfway to their neighbours: gaps of 0.02, 0.05, 0.1 from 0.005 to 0.035, 0.075 and 0.125.
  const ChartSeries grid = map_of_strength();
  EXPECT_EQ(grid.kind, ChartSeries::Kind::area);
  const auto expect_field = [&](const std::size_t n, const std::array<double, 4>& ends, const double value) {
    const auto& [left, right, bottom, top] = ends;
    const std::array<ChartPoint, 4> corners{
      {{left, bottom, 0.0, value}, {right, bottom, 0.0, value}, {right, top, 0.0, value}, {left, top, 0.0, value}}};
    for (std::size_t k = 0; k < 4; ++k)
      for (std::size_t c = 0; c < 4; ++c)
        EXPECT_NEAR(grid.points.at(5 * n + k)[c], corners[k][c], 1e-9) << n << ": " << k;
  };
  ASSERT_EQ(grid.points.size(), 6u * 5u); // four corners and a gap each
  expect_field(0, {5.0, 15.0, 0.005, 0.035}, 60.0);
  expect_field(4, {15.0, 25.0, 0.035, 0.075}, 120.0);
  // A design that is no grid has points; three entries, or one, have no map.
  all.pop_back();
  EXPECT_EQ(map_of_strength().kind, ChartSeries::Kind::marks);
  for (Series& series : all)
    series.tests[0].settings.pop_back();
  EXPECT_TRUE(map_of_strength().points.empty());
}

TEST(NumbersThatAreNone, AreNullInJsonWithTheReasonBesideThem)
{
  const double nan = std::numeric_limits<double>::quiet_NaN();
  const double infinity = std::numeric_limits<double>::infinity();
  const auto text = json_text({{"a", nan}, {"b", {{"c", -infinity}, {"d", {1.5, nan}}}}, {"e", 2}, {"f", "\xff"}});
  const auto json = nlohmann::json::parse(text);
  EXPECT_TRUE(json["a"].is_null());
  EXPECT_EQ(json["a_reason"], "it is no finite number");
  EXPECT_TRUE(json["b"]["c"].is_null());
  EXPECT_EQ(json["b"]["c_reason"], "it is no finite number");
  EXPECT_EQ(json["b"]["d"], nlohmann::json::parse("[1.5, null]"));
  EXPECT_EQ(json["e"], 2);
  EXPECT_TRUE(text.ends_with("}\n"));
}

/// A result folder of one test with two grains, one crack and a gauge of too few grains; a cell of a table changed.
std::vector<Series> read_with(const std::string& table, const std::string& from, const std::string& to)
{
  FinishedTest test = made(uniaxial_compression.kind, 80e6);
  test.appearance.grains_at_end.push_back({{0.0125, 0.0125, 0.0}, {0.0125, 0.0125, 0.0}, 0.00075, 0});
  test.record.cracks.push_back(
    {CrackKind::tension, 3, 0, 700, -7e-4, {0.0175, 0.0225, 0.0}, {1.0, 0.0, 0.0}, 3e-4, 0.1});
  test.record.events.push_back(
    {1, 700, 2e-4, -7e-4, 1, 0, 0.1, {0.0175, 0.0235, 0.0}, 0.0, {1.0, 0.5, 0.0, 3.0, 0.0, 0.0}});
  for (CurveSample& row : test.record.curve)
    row.gauge_lateral_strain = row.gauge_volumetric_strain = std::numeric_limits<double>::quiet_NaN();
  const TemporaryFolder folder;
  write_result_folder({}, {test}, {}, folder.path());
  if (!from.empty())
    {
      std::string text = content(folder.path() / table);
      text.replace(text.find(from), from.size(), to);
      folder.write(table, text);
    }
  return read_result_folder(folder.path(), test_kinds());
}

/// The only problem of a folder that was read.
std::string problem_of(const std::vector<Series>& read)
{
  EXPECT_EQ(read[0].problems.size(), 1u);
  return read[0].problems.empty() ? "" : read[0].problems[0];
}

TEST(ResultFolder, HasTheEventsOfAcousticEmission)
{
  const std::string first_columns =
    "event,step,axial_strain,x_m,y_m,z_m,n_breaks,energy_J,moment_Nm,magnitude,isotropic_share,"
    "double_couple_share,clvd_share,";
  const auto series = read_with("emission.csv", first_columns, first_columns);
  ASSERT_EQ(series[0].tests[0].record.events.size(), 1u);
  const EmissionEvent& event = series[0].tests[0].record.events[0];
  EXPECT_EQ(event.number, 1u);
  EXPECT_EQ(event.step, 700u);
  EXPECT_EQ(event.time, 2e-4);
  EXPECT_EQ(event.axial_strain, -7e-4);
  EXPECT_EQ(event.n_breaks(), 1u);
  EXPECT_EQ(event.released_energy, 0.1);
  EXPECT_EQ(event.centroid, (std::array{0.0175, 0.0235, 0.0}));
  EXPECT_EQ(event.moment, (std::array{1.0, 0.5, 0.0, 3.0, 0.0, 0.0}));

  const auto spoilt = read_with("emission.csv", "0.0235", "inf");
  EXPECT_TRUE(spoilt[0].tests[0].record.events.empty());
  EXPECT_TRUE(has(spoilt[0].problems[0], "emission.csv: line 2: y_m is inf"));
}

TEST(NumbersThatAreNone, InTablesAreNamedAndNeverReachThePage)
{
  EXPECT_TRUE(read_with("", "", "")[0].problems.empty()); // a gauge with too few grains is no mistake of a table

  const std::string grains = "grains/uniaxial_compression_seed_1.csv";
  const std::string curve = "curves/uniaxial_compression_seed_1.csv";
  for (const char* const none : {"nan", "-nan", "inf", "-inf"})
    {
      SCOPED_TRACE(none);
      const auto of_grains = read_with(grains, "0.0125", none);
      EXPECT_TRUE(
        has(problem_of(of_grains), fmt::format("{}: line 3: start_x_m is {}, no finite number; rows with such "
                                               "cells are left out",
                                               grains, none)));
      EXPECT_EQ(of_grains[0].tests[0].appearance.grains_at_end.size(), 1u);

      const auto of_cracks = read_with("cracks.csv", "0.0225", none);
      EXPECT_TRUE(has(problem_of(of_cracks), fmt::format("cracks.csv: line 2: y_m is {}", none)));
      EXPECT_TRUE(of_cracks[0].tests[0].record.cracks.empty());

      const auto of_curve = read_with(curve, "72000000", none); // 90 % of the strength
      EXPECT_TRUE(has(problem_of(of_curve), fmt::format("line 11: axial_stress_Pa is {}, no finite number; curves have "
                                                        "gaps there",
                                                        none)));
      ASSERT_EQ(of_curve[0].tests[0].record.curve.size(), 15u);
      const auto shown = nlohmann::json::parse(
        specimen_data({{&of_curve[0].tests[0], "rock"}}))["tests"][0]; // throws where a number is nan
      EXPECT_TRUE(shown["rows"][9][1].is_null());
      EXPECT_EQ(shown["cracks"]["joint"].get<std::string>().size(), 8u); // four bytes of one crack
    }
  // A text that is no number, or a number beyond their range, makes the table unreadable; the line says where.
  for (const char* const none : {"", "1e999", "-1e999"})
    EXPECT_TRUE(has(problem_of(read_with(grains, "0.0125", none)), grains + ":3: start_x_m: ")) << none;
}
} // namespace
} // namespace feldspar::tests

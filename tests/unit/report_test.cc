// Texts that the report writes and reads: compression positive where the laboratory has it so.

#include "app/screen/print_result.h"
#include "base/input_error.h"
#include "dem/lab/protocols/protocols.h"
#include "report/chart/page_writer.h"
#include "report/page/picture_book.h"
#include "report/page/table.h"
#include "report/pictures/curves/curve_pictures.h"
#include "report/pictures/envelope_curves.h"
#include "report/pictures/figures.h"
#include "report/pictures/maps/group_colour.h"
#include "report/pictures/maps/map.h"
#include "report/pictures/maps/specimen_data.h"
#include "report/report.h"
#include "report/sections/comparison.h"
#include "report/sections/findings.h"
#include "report/sections/provenance.h"
#include "report/sections/sections.h"
#include "report/sections/study_text.h"
#include "report/sections/tables.h"
#include "report/sections/text.h"
#include "report/sections/verdict.h"
#include "results/fits/residual_strength.h"
#include "results/fits/run_envelopes.h"
#include "results/folder/calibration_record.h"
#include "results/folder/result_folder.h"
#include "results/runs/bodies.h"
#include "results/runs/series.h"
#include "results/runs/test_groups.h"
#include "results/runs/trust.h"
#include "results/statistics.h"
#include "tests/content.h"
#include "tests/temporary_folder.h"
#include "tests/words.h"

#include <fmt/format.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <bit>
#include <cmath>
#include <limits>
#include <map>
#include <optional>
#include <sstream>
#include <string>
#include <tuple>
#include <vector>

namespace feldspar::tests
{
namespace
{
TEST(Statistics, AreThoseOfTheTextbook)
{
  // 1, 2, 3, 4: mean 2.5, squares 5, s.d. sqrt(5/3), standard error sqrt(5/12), t_{0.975, 3} = 3.182446 (any table).
  const auto four = *statistics({1.0, 2.0, 3.0, 4.0});
  EXPECT_NEAR(four.mean, 2.5, 1e-15);
  EXPECT_NEAR(*four.standard_deviation, std::sqrt(5.0 / 3.0), 1e-15);
  EXPECT_NEAR(*four.standard_error, std::sqrt(5.0 / 12.0), 1e-15);
  EXPECT_NEAR(*four.confidence_95, 3.182446 * std::sqrt(5.0 / 12.0), 1e-6);
  EXPECT_FALSE(statistics({1.0})->confidence_95);
  EXPECT_FALSE(statistics({}));
}

TEST(Statistics, AStandardDeviationOfFewValuesHasAWideIntervalOfItsOwn)
{
  // sqrt((n - 1) / q) with the quantiles q of chi-squared at 0.975 and 0.025 from tables: 19.023 and 2.700 for nine degrees
  // of freedom, 7.378 and 0.05064 for two; their last digits are 1e-4 of them.
  const Interval of_ten = deviation_interval_95(10);
  EXPECT_NEAR(of_ten.low, std::sqrt(9.0 / 19.023), 2e-4);
  EXPECT_NEAR(of_ten.high, std::sqrt(9.0 / 2.700), 5e-4);
  const Interval of_three = deviation_interval_95(3);
  EXPECT_NEAR(of_three.low, std::sqrt(2.0 / 7.378), 2e-4);
  EXPECT_NEAR(of_three.high, std::sqrt(2.0 / 0.05064), 2e-3);
}

/// A test in compression, a row each 1e-4 of strain: 60 GPa to 120 MPa, then down to 30 MPa.
FinishedTest compression(const std::uint64_t seed, const double scale = 1.0)
{
  FinishedTest test;
  test.group = "uniaxial_compression";
  test.name = fmt::format("uniaxial_compression_seed_{}", seed);
  TestRecord& record = test.record;
  record.kind = uniaxial_compression.kind;
  record.seed = seed;
  record.size = {0.05, 0.1, 0.0};
  record.bulk_density = 2700.0;
  test.bookkeeping.steps = 1000;
  test.bookkeeping.time_step = 1e-7;
  test.bookkeeping.wall_time = 2.5;
  record.specimen.n_grains = 2;
  record.specimen.n_joints = 1;
  record.specimen.resolution = 30.0;
  record.specimen.radius_multiplier = 1.001;
  record.specimen.coordination_number_core = std::nan("");
  for (int k = 0; k <= 30; ++k)
    {
      CurveSample row;
      row.step = std::uint64_t(10 * k);
      row.time = 1e-4 * k;
      row.axial_strain = row.gauge_axial_strain = -1e-4 * k;
      row.axial_stress = -scale * (k <= 20 ? 6e6 * k : 120e6 - 9e6 * (k - 20));
      row.gauge_lateral_strain = 2e-5 * k;
      row.gauge_volumetric_strain = -6e-5 * k;
      row.n_tension_cracks = std::uint64_t(k > 10 ? 3 * (k - 10) : 0);
      row.n_shear_cracks = std::uint64_t(k > 15 ? k - 15 : 0);
      row.energies = {1.0 * k, 1e-5 * k, 0.7 * k, 0.1 * k, 0.1 * k, 0.1 * k};
      record.curve.push_back(row);
    }
  for (std::uint32_t k = 0; k < 40; ++k)
    record.cracks.push_back({k % 4 ? CrackKind::tension : CrackKind::shear,
                             7,
                             k,
                             110 + 5 * k,
                             -1e-4 * (11.0 + 0.5 * k),
                             {0.02, 0.001 * k, 0.0},
                             {0.6, 0.8, 0.0},
                             3e-4,
                             0.1 / 3.0});
  test.appearance.grains_at_end = {{{0.01, 0.02, 0.0}, {0.011, 0.02, 0.0}, 0.00062, 0},
                                   {{0.03, 0.02, 0.0}, {0.034, 0.02, 0.0}, 0.001, 1}};
  record.fragments = fragments_of(test.appearance.grains_at_end, record.dimension());
  test.results = evaluate(record);
  return test;
}

/// A body with a ligament of 9 mm; its curve is that of `compression`.
FinishedTest notched(const TestKind& kind, const bool is_valid)
{
  FinishedTest test = compression(1);
  test.record.kind = kind;
  test.record.notch = NotchGeometry{.intensity_over_stress = 0.1,
                                    .work_over_stress = 1e-3,
                                    .ligament_area = 0.01,
                                    .ligament_length = 0.009,
                                    .is_valid = is_valid};
  test.results = evaluate(test.record);
  return test;
}

/// The row of a property; an empty one where there is none.
ComparisonRow comparison_of(const std::vector<ComparisonRow>& rows, const std::string& property)
{
  const auto row = std::ranges::find(rows, property, &ComparisonRow::property);
  EXPECT_NE(row, rows.end()) << property;
  return row == rows.end() ? ComparisonRow{} : *row;
}

const std::optional<Reference> no_reference;
const std::string no_problem;

TEST(ResultFolder, IsReadBackAsItWasWritten)
{
  const TemporaryFolder folder;
  FinishedTest failed;
  failed.group = "direct_tension";
  failed.name = "direct_tension_seed_3";
  failed.record.seed = 3;
  failed.record.kind = direct_tension.kind;
  failed.record.failure = "the grips slipped";
  failed.results = evaluate(failed.record);
  const std::vector<FinishedTest> written{compression(3), compression(4, 1.1), failed};
  const Provenance made_by{"0.1", "abc", "rock.prm", {{"Seeds", "Seeds", "3, 4"}}, "a processor", 2};
  write_result_folder(made_by, written, fit_each_rock(written), folder.path());
  const auto all = read_result_folder(folder.path(), test_kinds());
  ASSERT_EQ(all.size(), 1u);
  EXPECT_EQ(all[0].label, folder.path().filename().string());
  EXPECT_TRUE(all[0].problems.empty()) << all[0].problems.front();
  EXPECT_EQ(all[0].made_by.commit, "abc");
  EXPECT_EQ(all[0].made_by.input.at(0).value, "3, 4");
  ASSERT_EQ(all[0].tests.size(), written.size());
  for (std::size_t t = 0; t < written.size(); ++t)
    {
      const auto& was = written[t];
      const auto& is = all[0].tests[t];
      EXPECT_EQ(is.name, was.name);
      EXPECT_EQ(is.group, was.group);
      EXPECT_EQ(is.record.failure, was.record.failure);
      EXPECT_EQ(is.record.size, was.record.size);
      for (const TestQuantity& quantity : test_quantities)
        {
          EXPECT_EQ(value_of(quantity, is).value, value_of(quantity, was).value) << quantity.name;
          if (!value_of(quantity, was).value)
            {
              EXPECT_EQ(value_of(quantity, is).reason, value_of(quantity, was).reason) << quantity.name;
            }
        }
    }
  // Written again, the same bytes: nothing was lost on the way.
  const TemporaryFolder again;
  write_result_folder(made_by, all[0].tests, fit_each_rock(all[0].tests), again.path());
  for (const char* file : {"summary.json", "cracks.csv", "curves/uniaxial_compression_seed_3.csv",
                           "grains/uniaxial_compression_seed_4.csv"})
    EXPECT_EQ(content(again.path() / file), content(folder.path() / file)) << file;
  EXPECT_GT(content(folder.path() / "cracks.csv").size(), 1000u);
}

TEST(ResultFolder, OfVariantsIsASeriesForEach)
{
  const TemporaryFolder folder;
  auto slow = compression(1);
  slow.variant = "Tests/Compression strain rate = 0.5 1/s";
  slow.settings = {{"Tests/Compression strain rate", "0.5 1/s"}, {"Specimen/Joint law", "flat joint"}};
  auto fast = compression(1);
  fast.name += "_variant_2";
  fast.variant = "Tests/Compression strain rate = 1 1/s";
  fast.settings = {{"Tests/Compression strain rate", "1 1/s"}, {"Specimen/Joint law", "flat joint"}};
  write_result_folder({}, {slow, fast}, {}, folder.path());
  const auto all = read_result_folder(folder.path(), test_kinds());
  ASSERT_EQ(all.size(), 2u);
  EXPECT_EQ(all[0].label, slow.variant);
  const auto& settings = all[0].tests.at(0).settings;
  ASSERT_EQ(settings.size(), 2u);
  EXPECT_EQ(settings[0].entry, "Tests/Compression strain rate");
  EXPECT_EQ(settings[0].value, "0.5 1/s");
  EXPECT_EQ(settings[1].value, "flat joint");
  EXPECT_EQ(all[1].tests.at(0).name, fast.name);
}

TEST(ResultFolder, OfAnotherLayoutIsReadAsFarAsItGoes)
{
  const TemporaryFolder folder;
  folder.write("summary.json", R"({"schema_version": 0, "tests": [
    {"kind": "uniaxial_compression", "name": "uniaxial_compression_seed_1", "seed": 1, "peak_stress_Pa": 150e6},
    {"kind": "shaken", "name": "shaken_seed_1"}, 7]})");
  const auto all = read_result_folder(folder.path(), test_kinds());
  ASSERT_EQ(all.size(), 1u);
  ASSERT_EQ(all[0].tests.size(), 1u);
  EXPECT_EQ(*all[0].tests[0].results.peak_stress.value, 150e6);
  EXPECT_EQ(all[0].tests[0].group, "uniaxial_compression");
  EXPECT_EQ(all[0].tests[0].results.youngs_modulus_initial.reason, "not in this result folder");
  const std::string said = joined(all[0].problems);
  EXPECT_TRUE(has(said, "layout 0", "does not know was left out", "uniaxial_compression_seed_1.csv: cannot be read",
                  "cracks.csv: cannot be read"));
}

/// Layout 1 had the RVEs of a test under the key `volumes`.
TEST(ResultFolder, OfTheLayoutBeforeIsReadInFull)
{
  const TemporaryFolder folder;
  auto test = compression(1);
  test.appearance.rves.push_back({"most damaged", 3, 1, {}, 7, {}, {}});
  write_result_folder({}, {test}, {}, folder.path());
  auto json = nlohmann::ordered_json::parse(content(folder.path() / "summary.json"));
  json["schema_version"] = 1;
  json["tests"][0]["volumes"] = json["tests"][0]["rves"];
  json["tests"][0].erase("rves");
  folder.write("summary.json", json.dump());
  const auto all = read_result_folder(folder.path(), test_kinds());
  EXPECT_TRUE(all.at(0).problems.empty()) << all[0].problems[0];
  const auto& rves = all[0].tests.at(0).appearance.rves;
  ASSERT_EQ(rves.size(), 1u);
  EXPECT_EQ(rves[0].which, "most damaged");
  EXPECT_EQ(rves[0].cell, 3u);
  EXPECT_EQ(rves[0].n_segments, 7u);
}

TEST(ResultFolder, ToughnessAndNotchAreReadBackForThePage)
{
  const TemporaryFolder folder;
  const FinishedTest bent = notched(three_point_bending.kind, true);
  ASSERT_TRUE(bent.results.fracture_toughness.value);
  write_result_folder({}, {bent}, {}, folder.path());
  const auto tests = read_result_folder(folder.path(), test_kinds()).at(0).tests;
  ASSERT_TRUE(tests.at(0).record.notch);
  EXPECT_EQ(tests.at(0).record.notch->ligament_length, 0.009);
  const auto toughness = comparison_of(compare(tests, std::nullopt), "fracture toughness, three point bending");
  ASSERT_TRUE(toughness.ours);
  EXPECT_NEAR(toughness.ours->mean, *bent.results.fracture_toughness.value / 1e6, 1e-9);

  // A folder from before the length was written has the notch without it.
  auto summary = nlohmann::json::parse(content(folder.path() / "summary.json"));
  summary["tests"][0]["notch"].erase("ligament_length_m");
  folder.write("summary.json", summary.dump());
  const auto older = read_result_folder(folder.path(), test_kinds()).at(0).tests;
  ASSERT_TRUE(older.at(0).record.notch);
  EXPECT_TRUE(std::isnan(older.at(0).record.notch->ligament_length));
}

TEST(ResultFolder, StagesAreReadBackUnlessTheyAreNotThoseOfTheCurve)
{
  const TemporaryFolder folder;
  FinishedTest test = compression(1);
  test.record.kind = own_loading.kind;
  test.record.stages = {{"axial strain 0.001", 5e6, 0, 2, true}, {"axial stress 10 MPa", 0.0, 2, 4, false}};
  write_result_folder({}, {test}, {}, folder.path());
  const auto stages = read_result_folder(folder.path(), test_kinds()).at(0).tests.at(0).record.stages;
  ASSERT_EQ(stages.size(), 2u);
  EXPECT_EQ(stages[1].target, "axial stress 10 MPa");
  EXPECT_EQ(stages[1].last_row, 4u);
  EXPECT_FALSE(stages[1].reached);

  auto summary = nlohmann::json::parse(content(folder.path() / "summary.json"));
  summary["tests"][0]["stages"][1]["last_row"] = 100000;
  folder.write("summary.json", summary.dump());
  const auto all = read_result_folder(folder.path(), test_kinds());
  EXPECT_TRUE(all.at(0).tests.at(0).record.stages.empty());
  ASSERT_FALSE(all.at(0).problems.empty());
  EXPECT_TRUE(has(all[0].problems.back(), "the stages of uniaxial_compression_seed_1 are not those of its curve"));
}

TEST(ResultFolder, ThatIsNoneIsRefused)
{
  const TemporaryFolder folder;
  const auto refused = [&](const std::string& words) {
    EXPECT_TRUE(has(refusal([&] { read_result_folder(folder.path(), test_kinds()); }), words));
  };
  refused("there is no summary.json in it");
  folder.write("summary.json", "{\"tests\": [");
  refused("summary.json:1:12: is not valid JSON: ");
  folder.write("summary.json", "[]");
  refused("there is no list of \"tests\"");
  folder.write("summary.json", "{\"stiffness_Pa\": 1}");
  refused("there is no list of \"tests\"");
  folder.write("summary.json", "{\"tests\": []}");
  refused("there is no test in it");
}

TEST(ResultFolder, ACurveThatIsCutShortIsSaidAndTheRestKept)
{
  const TemporaryFolder folder;
  write_result_folder({}, {compression(3), compression(4)}, {}, folder.path());
  std::filesystem::create_directories(folder.path() / "curves");
  folder.write("curves/uniaxial_compression_seed_3.csv", "step,time_s\n1,2\n");
  folder.write("curves/uniaxial_compression_seed_4.csv",
               content(folder.path() / "curves/uniaxial_compression_seed_4.csv") + "1,2,3\n");
  const auto all = read_result_folder(folder.path(), test_kinds());
  ASSERT_EQ(all[0].problems.size(), 2u);
  EXPECT_TRUE(has(all[0].problems[0], "uniaxial_compression_seed_3.csv:1: there is no column axial_strain"));
  EXPECT_TRUE(
    has(all[0].problems[1], "uniaxial_compression_seed_4.csv:33: there must be 20 values, one for each of step,"));
  EXPECT_EQ(all[0].tests[0].record.cracks.size(), 40u);
  EXPECT_TRUE(all[0].tests[0].results.peak_stress.value);
}

TEST(ResultFolder, KnowsTestsOnFiniteElementsAndWhatTheyCannotHave)
{
  FinishedTest test = compression(3);
  test.record.body = TestBody::finite_elements;
  test.appearance.grains_at_end.clear();
  test.record.fragments.reset();
  test.record.ended_early = "no equilibrium was found";
  test.results = evaluate(test.record);
  const TemporaryFolder folder;
  write_result_folder({}, {test}, {}, folder.path());
  EXPECT_FALSE(std::filesystem::exists(folder.path() / "grains"));

  const auto all = read_result_folder(folder.path(), test_kinds());
  ASSERT_EQ(all.size(), 1u);
  EXPECT_EQ(all[0].kind, SeriesKind::finite_elements);
  EXPECT_TRUE(all[0].problems.empty()); // that there are no grains is none
  const TestResults& results = all[0].tests[0].results;
  EXPECT_TRUE(results.peak_stress.value);
  EXPECT_EQ(results.kinetic_to_strain_energy.reason, "equilibrium is sought without time");
  EXPECT_EQ(results.p_wave_transits_to_peak.reason, "equilibrium is sought without time");
  EXPECT_EQ(results.n_fragments.reason, "there are no grains to be counted");
  EXPECT_TRUE(has(joined(warnings(all[0])), "ended early: no equilibrium was found.", "Only 1 sample:"));
}

TEST(Band, IsMeanAndDeviationAtTheSameStrain)
{
  // Two tests whose stresses are in the ratio of 1 to 1.1: mean 1.05, s.d. 0.1/sqrt(2) of the first.
  const Series series{"two", SeriesKind::specimens, {}, {compression(3), compression(4, 1.1)}, {}};
  const auto groups = groups_of(series);
  ASSERT_EQ(groups.size(), 1u);
  const Band stress = band(
    groups[0], [](const CurveSample& row) { return row.axial_stress; }, true);
  ASSERT_FALSE(stress.abscissa.empty());
  EXPECT_NEAR(stress.abscissa.back(), 30e-4, 1e-12);
  for (std::size_t k = 0; k < stress.abscissa.size(); ++k)
    {
      const double strain = stress.abscissa[k];
      const double first = strain <= 20e-4 ? 60e9 * strain : 120e6 - 90e9 * (strain - 20e-4);
      // Rows are 1e-4 apart and the kink is one of them: linear between them is exact.
      EXPECT_NEAR(stress.mean[k], 1.05 * first, 1.0) << strain;
      EXPECT_NEAR(stress.deviation[k], 0.1 / std::sqrt(2.0) * first, 1.0) << strain;
    }
}

TEST(Band, OfATestThatGoesBackAndForthIsOverTime)
{
  // Pressed to 2e-3 in 2 ms and back to 1e-3 in 1 ms, without a change of the stiffness of 60 GPa.
  FinishedTest test = compression(3);
  test.record.kind = own_loading.kind;
  test.record.curve.clear();
  for (int k = 0; k <= 30; ++k)
    {
      CurveSample row;
      row.time = 1e-4 * k;
      row.axial_strain = -1e-4 * (k <= 20 ? k : 40 - k);
      row.axial_stress = 60e9 * row.axial_strain;
      test.record.curve.push_back(row);
    }
  const Series series{"one", SeriesKind::specimens, {}, {test}, {}};
  const Band stress = band(
    groups_of(series)[0], [](const CurveSample& row) { return row.axial_stress; }, true);
  ASSERT_FALSE(stress.abscissa.empty());
  EXPECT_NEAR(stress.abscissa.back(), 3e-3, 1e-12);
  EXPECT_NEAR(*std::max_element(stress.mean.begin(), stress.mean.end()), 120e6, 1e6);
  EXPECT_NEAR(stress.mean.back(), 60e6, 1.0);
}

Reference granite(const double low, const double high)
{
  Reference reference;
  reference.experiment.label = "experiment";
  reference.experiment.values["uniaxial_compressive_strength_MPa"] = {125.0, low, high};
  reference.experiment.values["youngs_modulus_GPa"] = {50.0, std::nullopt, std::nullopt};
  return reference;
}

TEST(Verdict, SaysInWordsWhatIsInAndWhatIsOutOfRange)
{
  // 120, 126 and 132 MPa: mean 126, 95 % of the mean ± 4.303·6/sqrt(3) = 15 MPa.
  std::vector<FinishedTest> tests{compression(3), compression(4, 1.1), compression(5, 1.05)};
  const auto said = [&](const std::optional<Reference>& reference, const std::string& problem) {
    const Verdict answer = verdict(compare(tests, reference), reference, problem);
    std::string text = answer.headline + "\n";
    for (const Tile& tile : answer.tiles)
      text += fmt::format("{}: {}, n = {}; {}\n", tile.property, tile.value, tile.n, tile.notes);
    return text;
  };
  EXPECT_TRUE(has(
    said(granite(120.0, 130.0), ""),
    "Yes. Uniaxial compressive strength lies within the measured range (3 specimens). Young's modulus is given without a "
    "range and deviates by",
    "uniaxial compressive strength: 126.0 ± 6.0 MPa, n = 3; experiment 125.0", "+0.8 %",
    "the 95 % interval of the mean, 111.1 to 140.9, reaches out of the range", "Young's modulus"));
  EXPECT_TRUE(has(
    said(granite(127.0, 130.0), ""),
    "Not decided by 3 specimens. Uniaxial compressive strength is outside the measured range, but its 95 % interval "
    "reaches into it.",
    "experiment 125.0 (127.0 to 130.0) MPa, +0.8 %; not decided by 3 specimens: the 95 % interval of the mean, 111.1 "
    "to 140.9, reaches into the range"));
  EXPECT_TRUE(
    has(said(granite(141.0, 150.0), ""),
        "No. Uniaxial compressive strength is outside the measured range (3 specimens). Young's modulus is given"));
  // All of the interval inside, or all of it outside: no such remark.
  EXPECT_FALSE(has(said(granite(1.0, 500.0), ""), "reaches"));
  EXPECT_FALSE(has(said(granite(300.0, 500.0), ""), "reaches"));
  // The unit belongs to the mean, not to the number of tests.
  Reference of_tests = granite(120.0, 130.0);
  of_tests.experiment.values["uniaxial_compressive_strength_MPa"].n = 6;
  EXPECT_TRUE(has(said(of_tests, ""), "experiment 125.0 MPa, n = 6 (120.0 to 130.0), +0.8 %"));
  EXPECT_TRUE(has(said(std::nullopt, "no such file"), "Nothing to compare with: no such file."));
  // Fewer specimens have no such interval, which is said instead.
  tests.pop_back();
  EXPECT_TRUE(
    has(said(granite(1.0, 500.0), ""), ": 120.0 and 132.0 MPa, n = 2;", "two specimens are too few to be sure"));
  const std::string on_terminal = as_text(compare(tests, std::nullopt), std::nullopt);
  EXPECT_TRUE(has(on_terminal, "  n = 2: 120.0 and 132.0\n"));
  // The mean of 120 and 132 MPa is 126 ± 12.706·6 = 76 MPa.
  EXPECT_TRUE(has(said(granite(203.0, 300.0), ""),
                  "No. Uniaxial compressive strength is outside the measured range (2 specimens)."));
  EXPECT_TRUE(has(said(granite(202.0, 300.0), ""), "Not decided by 2 specimens.",
                  "not decided by 2 specimens: the 95 % interval of the mean reaches into the range"));
  tests.pop_back();
  EXPECT_TRUE(has(said(granite(1.0, 500.0), ""), "120.0 MPa, n = 1;", "one specimen is too few to be sure"));
  EXPECT_TRUE(has(
    said(granite(300.0, 500.0), ""),
    "Not decided by one specimen. Uniaxial compressive strength is outside the measured range, but one specimen has "
    "no 95 % interval.",
    "not decided by one specimen, which has no 95 % interval"));
}

/// A property in MPa, measured to be 100 (90 to 110), or without a range.
ComparisonRow property(const std::string& name, const std::vector<double>& values, const bool has_range = true)
{
  ReferenceValue measured{100.0, std::nullopt, std::nullopt};
  if (has_range)
    std::tie(measured.low, measured.high) = std::pair(90.0, 110.0);
  return {name, "MPa", 1, statistics(values), std::nullopt, measured, name};
}

// Three values x - 2, x and x + 2 have a standard deviation of 2, so that Student's t of two degrees of freedom, 4.303, gives
// an interval of x ± 4.303·2/sqrt(3) = x ± 4.97.
TEST(Verdict, IsOneForSentenceTileAndTables)
{
  const auto around = [](const double mean) { return std::vector{mean - 2.0, mean, mean + 2.0}; };
  const ComparisonRow within = property("strength a", around(109.0)), open = property("strength b", around(114.9)),
                      outside = property("strength c", around(115.0)), below = property("strength d", around(85.1));
  EXPECT_EQ(within.against_range(), RangeVerdict::within);
  EXPECT_EQ(open.against_range(), RangeVerdict::not_decided);
  EXPECT_EQ(outside.against_range(), RangeVerdict::outside);
  EXPECT_EQ(below.against_range(), RangeVerdict::not_decided);

  EXPECT_EQ(
    verdict_sentence({within, open, outside}),
    "No. Strength c is outside the measured range (3 specimens); strength b is not decided; 1 of 3 properties lies "
    "within.");
  EXPECT_EQ(verdict_sentence({within, open, below}),
            "Not decided by 3 specimens. Strength b and strength d are outside the measured ranges, but their 95 % "
            "intervals reach into them; 1 of 3 properties lies within.");
  EXPECT_EQ(verdict_sentence({within}), "Yes. Strength a lies within the measured range (3 specimens).");

  const std::vector<Tile> tiles = verdict({within, open, outside}, std::nullopt, "").tiles;
  ASSERT_EQ(tiles.size(), 3u);
  EXPECT_EQ(tiles[0].mark, TileMark::good);
  EXPECT_EQ(tiles[1].mark, TileMark::not_decided);
  EXPECT_EQ(tiles[2].mark, TileMark::bad);

  const std::vector<Series> all{{"model", SeriesKind::specimens, {}, {compression(1)}, {}}};
  const std::optional<Reference> reference = granite(90.0, 110.0);
  const Findings findings{all, all, reference, no_problem, true, {{within, open, outside}}, {}};
  const Table table = comparison_table(findings);
  std::string cells;
  for (const auto& row : table.rows)
    cells += fmt::format("{}\n", fmt::join(row, " | "));
  EXPECT_TRUE(has(cells, "✓ +9.0 %, in range", "? +14.9 %, not decided", "✗ +15.0 %, out of range"));
  const DataFrame frame = comparison_frame(findings);
  ASSERT_EQ(frame.header.back(), "verdict");
  std::vector<std::string> verdicts;
  for (const auto& row : frame.rows)
    if (row.front() == "model" && row.back() != "")
      verdicts.push_back(row.back());
  EXPECT_EQ(verdicts, (std::vector<std::string>{"within", "not decided", "outside"}));
}

// 72.9 and 137.1 beside 100 are 27.1 % too low and 37.1 % too high.
TEST(Verdict, NamesThePropertyThatDeviatesMost)
{
  const ComparisonRow modulus = property("Young's modulus, initial", {72.9}, false),
                      ratio = property("Poisson's ratio, secant at 50 % of peak", {137.1}, false);
  EXPECT_EQ(verdict_sentence({modulus, ratio}),
            "Young's modulus and Poisson's ratio are given without a range and deviate "
            "by up to +37.1 % (Poisson's ratio).");
  EXPECT_EQ(verdict_sentence({modulus}), "Young's modulus is given without a range and deviates by −27.1 %.");
}

TEST(Verdict, OfADiscThatBearsMoreAfterItsFirstFallSaysSo)
{
  FinishedTest test = compression(1);
  test.record.kind = brazilian.kind;
  test.name = "brazilian_seed_1";
  test.record.curve.clear();
  test.record.cracks.clear();
  for (const double stress : {0.0, 4e6, 8e6, 10e6, 7e6, 9e6, 12e6})
    {
      CurveSample row;
      row.axial_strain = -1e-4 * double(test.record.curve.size());
      row.axial_stress = -stress;
      test.record.curve.push_back(row);
    }
  test.results = evaluate(test.record);
  EXPECT_EQ(*test.results.peak_stress.value, 10e6);
  for (const Figure& after_peak : {test.results.post_peak_drop, test.results.residual_deviator_ratio})
    {
      EXPECT_FALSE(after_peak.value);
      EXPECT_TRUE(has(after_peak.reason, "before the first fall"));
    }
  EXPECT_TRUE(has(joined(warnings({"one", SeriesKind::specimens, {}, {test}, {}})),
                  "brazilian_seed_1 bore 1.20 times its strength after its first fall, by which the strength is "
                  "taken.\n"));
}

/// Compressions of two seeds of a body.
Series body(const std::string& label, const SeriesKind kind, const double gap, const double in_the_bulk)
{
  Series series{label, kind, {}, {compression(1), compression(2)}, {}};
  for (FinishedTest& test : series.tests)
    {
      SpecimenReport& specimen = test.record.specimen;
      specimen.installation_gap_ratio = gap * (test.record.seed == 1 ? 0.9 : 1.1);
      specimen.coordination_number_core = in_the_bulk;
      specimen.porosity = 0.16;
    }
  return series;
}

// Means over the seeds count: gaps of seeds may scatter by more than the bound of 5 % between two bodies.
TEST(Bodies, OfDifferentGapsAreSaidToBeDifferentRocks)
{
  const Series grains = body("direct", SeriesKind::specimens, 0.0457, 4.36);
  const Series alike = body("alike", SeriesKind::finite_elements, 0.0457 * 1.04, 4.36);
  const Series sample = body("multiscale", SeriesKind::finite_elements, 0.0237, 4.2);
  EXPECT_TRUE(gap_remarks({grains, alike}).empty());
  const auto remarks = gap_remarks({grains, alike, sample});
  ASSERT_EQ(remarks.size(), 1u);
  EXPECT_TRUE(has(remarks[0], "direct and multiscale are different rocks", "0.0457 and 0.0237 mean radii",
                  "4.36 and 4.20", "0.160 and 0.160"));
  // A curve measured on rock has no gap, nor has a sample without grains.
  Series measured = body("curve", SeriesKind::laboratory_curve, 0.5, 9.0);
  Series without = body("continuum", SeriesKind::finite_elements, 0.5, 9.0);
  for (FinishedTest& test : without.tests)
    test.record.specimen.n_grains = 0;
  EXPECT_TRUE(gap_remarks({measured, without, grains}).empty());
  EXPECT_EQ(as_text(*body_figures(sample)),
            "multiscale: gap 0.0237 mean radii, coordination number 4.20 in the bulk, porosity 0.160");
  // The comparison shows them as properties of the rock: of gaps 0.9 and 1.1 times the mean.
  const auto gap = comparison_of(compare(grains.tests, std::nullopt), "installation gap over mean radius");
  EXPECT_NEAR(gap.ours->mean, 0.0457, 1e-12);
  EXPECT_NEAR(*gap.ours->standard_deviation, 0.2 * 0.0457 / std::sqrt(2.0), 1e-12);
}

TEST(Bodies, OfASeedAreItsWholeSpecimen)
{
  // A disc that is tested first has fewer grains and a ragged rim.
  std::vector<FinishedTest> tests{compression(1), compression(1)};
  tests[1].record.specimen = {};
  tests[1].record.specimen.n_grains = 149;
  tests[1].record.specimen.porosity = 0.19;
  tests[0].record.specimen = tests[1].record.specimen;
  tests[0].record.specimen.n_grains = 97;
  tests[0].record.specimen.porosity = 0.33;
  EXPECT_EQ(whole_bodies(tests).at(1).porosity, 0.19);
  EXPECT_EQ(body_figures({"rock", SeriesKind::specimens, {}, tests, {}})->porosity.mean, 0.19);
}

TEST(Trust, SaysWhatIsOutOfItsBounds)
{
  // Energies of compression(): 1 - 0.7 - 3·0.1 - 1e-5 of the work is unaccounted, 0.001 %.
  Series series{"rock", SeriesKind::specimens, {}, {compression(1), compression(2), compression(3)}, {}};
  EXPECT_TRUE(warnings(series).empty()) << warnings(series).front();

  series.tests[1].results.energy_imbalance_over_work = 0.02;
  series.tests[2].record.interrupted = true;
  series.tests[2].results = evaluate(series.tests[2].record);
  series.problems = {"curves/a.csv: cannot be read"};
  EXPECT_TRUE(has(
    joined(warnings(series)),
    "Out of bounds in 1 of 3 tests: energy imbalance over boundary work; worst 2.00 % (uniaxial_compression_seed_2)",
    "uniaxial_compression_seed_3 has no strength: interrupted before its end", "curves/a.csv: cannot be read"));

  series.tests.resize(1);
  EXPECT_TRUE(has(joined(warnings(series)), "Only 1 specimen:"));
}

TEST(Trust, SaysWhereATestEndedTooNearToItsPeakToShowIt)
{
  Series series{"x", SeriesKind::specimens, {}, {compression(1), compression(2), compression(3)}, {}};
  TestRecord& record = series.tests[1].record;
  const std::size_t peak = *peak_row(record);
  CurveSample last = record.curve[peak];
  last.axial_strain *= 1.03;
  last.axial_stress *= 0.97;
  record.curve.resize(peak + 1);
  record.curve.push_back(last);
  record.peak_demands = {.least_fall = 0.02, .may_end_rising = true}; // by default it would have no peak
  series.tests[1].results = evaluate(record);
  const auto said = warnings(series);
  ASSERT_EQ(said.size(), 1u);
  EXPECT_EQ(said[0],
            "uniaxial_compression_seed_2 ended at 1.03 times the strain of its peak and still bore 97 % of the "
            "strength: a higher peak may lie beyond; a greater Tests/Stop strain shows it.");
  record.curve.clear(); // of a summary that is alone
  EXPECT_TRUE(warnings(series).empty()) << warnings(series).front();
}

TEST(Trust, SaysOnceWhatIsSoOfAllModels)
{
  std::vector<Series> series{{"a", SeriesKind::specimens, {}, {compression(1), compression(2), compression(3)}, {}},
                             {"b", SeriesKind::specimens, {}, {compression(1), compression(2), compression(3)}, {}},
                             {"rock", SeriesKind::laboratory_curve, {}, {compression(1)}, {}}};
  series[0].tests[0].results.energy_imbalance_over_work = 0.02;
  series[1].tests[2].results.energy_imbalance_over_work = 0.03;
  series[1].tests[1].results.kinetic_to_strain_energy = {0.5, ""};
  const SharedWarnings shared = shared_warnings(series);
  ASSERT_EQ(shared.of_all.size(), 1u);
  EXPECT_EQ(shared.of_all[0], "Out of bounds in 2 of 6 tests: energy imbalance over boundary work; worst 3.00 % "
                              "(uniaxial_compression_seed_3), bound at most 1 %.");
  EXPECT_TRUE(shared.own[0].empty()) << shared.own[0].front();
  ASSERT_EQ(shared.own[1].size(), 1u);
  EXPECT_TRUE(has(shared.own[1][0], "kinetic over strain energy"));
  EXPECT_TRUE(shared.own[2].empty());
  // One model alone has nothing to share.
  EXPECT_EQ(shared_warnings({series[1]}).own[0].size(), 2u);
}

TEST(Trust, OfManyVariantsIsTheWorstOfAll)
{
  std::vector<FinishedTest> tests;
  for (const char* const variant : {"a", "b", "c", "d"})
    {
      tests.push_back(compression(1));
      tests.back().variant = variant;
    }
  tests[2].name = "the third";
  tests[2].results.energy_imbalance_over_work = 0.02;
  const std::string text = trust_as_text(tests);
  EXPECT_TRUE(has(text, "1 of 4 tests out, worst the third"));
  EXPECT_EQ(times(text, "Only 1 specimen"), 1u) << text;
}

TEST(Study, ForATerminalHasALineAVariant)
{
  std::vector<FinishedTest> tests;
  for (int k = 1; k <= 4; ++k)
    for (const std::uint64_t seed : {1, 2})
      {
        tests.push_back(compression(seed));
        tests.back().settings = {{"Flat joint/Friction", std::to_string(k)}};
        tests.back().variant = "Flat joint/Friction = " + std::to_string(k);
        tests.back().results.peak_stress = {(100.0 + 10.0 * k + double(seed)) * 1e6, ""};
      }
  const std::string text = study_as_text(tests, std::nullopt);
  EXPECT_TRUE(has(text, "4 variants, means over the seeds\n   1  uniaxial compressive strength [MPa]\n",
                  "\n      1   Flat joint/Friction\n  111.5   1\n  121.5   2\n  131.5   3\n  141.5   4\n",
                  "\nthe same in all variants\n"));
}

TEST(Trust, SaysWhenThePackingOrTheElasticityIsNotWhatARockHas)
{
  Series series{"x", SeriesKind::specimens, {}, {compression(1), compression(2), compression(3)}, {}};
  // Wanted was 0.05: radii times m leave 1 - 0.17 = 0.95 m² of the plane to grains.
  SpecimenReport& packed = series.tests[0].record.specimen;
  packed.porosity = 0.17;
  packed.radius_multiplier = std::sqrt(0.83 / 0.95);
  series.tests[1].results.poissons_ratio_secant = {1.03, ""};
  const auto checks = trust_checks(series);
  const auto check = [&](const std::string_view name) {
    return *std::find_if(checks.begin(), checks.end(), [&](const auto& one) { return one.measure.name == name; });
  };
  EXPECT_NEAR(check("porosity_change").worst, 0.12, 1e-12);
  EXPECT_EQ(check("porosity_change").worst_test, series.tests[0].name);
  EXPECT_EQ(check("porosity_change").n_out, 1u);
  EXPECT_EQ(check("poissons_ratio_secant").n_out, 1u);
  EXPECT_EQ(check("poissons_ratio_initial").n_out, 0u);
  EXPECT_TRUE(has(as_text(checks), "✗ Poisson's ratio, secant at 50 % of peak\n    worst 1.030, bound at most 0.5"));
}

TEST(Summary, HasTheVerdictOfTheReport)
{
  const TemporaryFolder folder;
  std::vector<FinishedTest> tests{compression(1), compression(2), compression(3)};
  tests[1].results.kinetic_to_strain_energy = {0.728, ""};
  write_result_folder({}, tests, {}, folder.path());
  const auto summary = nlohmann::json::parse(content(folder.path() / "summary.json"));
  const auto& checks = summary["verdict"][0]["checks"];
  const auto kinetic = std::find_if(checks.begin(), checks.end(),
                                    [](const auto& one) { return one["measure"] == "kinetic_to_strain_energy"; });
  ASSERT_NE(kinetic, checks.end());
  EXPECT_EQ((*kinetic)["at_most"], 0.01);
  EXPECT_EQ((*kinetic)["worst"], 0.728);
  EXPECT_EQ((*kinetic)["worst_test"], tests[1].name);
  EXPECT_EQ((*kinetic)["n_out_of_bounds"], 1);
  const Series series = read_result_folder(folder.path(), test_kinds()).at(0);
  EXPECT_EQ(summary["verdict"][0]["warnings"].get<std::vector<std::string>>(), warnings(series));
}

TEST(Summary, AveragesTheTestsThatWereMade)
{
  // One of two could not be made: its counts are not zero, there are none.
  const TemporaryFolder folder;
  std::vector<FinishedTest> tests{compression(1), {}};
  tests[1].group = tests[0].group;
  tests[1].name = "uniaxial_compression_seed_2";
  tests[1].record.kind = uniaxial_compression.kind;
  tests[1].record.failure = "the platens slipped";
  tests[1].results = evaluate(tests[1].record);
  write_result_folder({}, tests, {}, folder.path());
  const auto summary = nlohmann::json::parse(content(folder.path() / "summary.json"));
  const auto& group = summary["ensemble"]["uniaxial_compression"];
  EXPECT_EQ(group["n_tests"], 2);
  EXPECT_EQ(group["n_made"], 1);
  EXPECT_EQ(group["n_tension_cracks"]["n"], 1);
  EXPECT_EQ(group["n_tension_cracks"]["mean"], double(tests[0].results.n_tension_cracks));
  EXPECT_TRUE(summary["tests"][1]["n_tension_cracks"].is_null());
  EXPECT_EQ(summary["tests"][1]["n_tension_cracks_reason"], "the platens slipped");
}

/// A test on the specimen of a seed that gave a point of an envelope.
FinishedTest pressed(const double confinement, const double strength, const std::uint64_t seed = 1)
{
  FinishedTest test = compression(seed);
  test.record.kind = confinement > 0.0 ? triaxial_compression.kind : uniaxial_compression.kind;
  test.record.confining_pressure = confinement;
  test.results.peak_stress = {strength, ""};
  return test;
}

TEST(EnvelopePicture, GoesNoFurtherThanItsPointsAndNeedsFreedom)
{
  // The rock was tested to 60 MPa, so that the plot goes on beyond the points of the model.
  std::optional<Reference> reference(std::in_place);
  reference->experiment.values["strength_at_60_MPa"] = {500.0, std::nullopt, std::nullopt};
  const auto curves_of = [&](const std::vector<FinishedTest>& tests) {
    const std::vector<Series> all{{"rock", SeriesKind::specimens, {}, tests, {}}};
    const StrengthEnvelopes envelopes = fit_strength_envelopes(strength_data(tests));
    std::map<std::string, std::vector<ChartPoint>> curves;
    const Pictures pictures = envelope_pictures({all, 0, envelopes, reference});
    for (const ChartSeries& series : pictures.at(0).panels.at(0).series)
      curves[series.label] = series.points;
    return curves;
  };
  const auto of_two = curves_of({pressed(0.0, 120e6), pressed(10e6, 200e6)});
  for (const auto& [label, points] : of_two)
    EXPECT_EQ(label.find("Mohr–Coulomb") + label.find("H–B"), 2 * std::string::npos) << label;
  auto of_three = curves_of({pressed(0.0, 120e6), pressed(10e6, 200e6), pressed(20e6, 250e6)});
  ASSERT_TRUE(of_three.contains("Mohr–Coulomb"));
  EXPECT_NEAR(of_three["Mohr–Coulomb"].back()[0], 20.0, 1e-6);

  // A printed envelope ends where the points of its source do, though the plot goes on to those of the model.
  reference->experiment.values = {{"strength_at_20_MPa", {300.0, std::nullopt, std::nullopt}},
                                  {"friction_angle_deg", {40.0, std::nullopt, std::nullopt}},
                                  {"cohesion_MPa", {30.0, std::nullopt, std::nullopt}}};
  const auto printed = curves_of({pressed(0.0, 120e6), pressed(60e6, 500e6)});
  std::size_t n_printed = 0;
  for (const auto& [label, points] : printed)
    if (label.ends_with(": c and φ, printed"))
      {
        ++n_printed;
        EXPECT_NEAR(points.back()[0], 20.0, 1e-9);
      }
  EXPECT_EQ(n_printed, 1u);
}

TEST(EnvelopeTable, SaysWhichFormsItsPointsDoNotDetermine)
{
  // Four means that no smooth curve follows: with three parameters nothing is known of them, with two a little.
  const StrengthData data{{{0.0, 223.8e6}, {10e6, 358.4e6}, {30e6, 448.2e6}}, 223.8e6, 12.67e6};
  const std::vector<Series> all{{"rock", SeriesKind::specimens, {}, {compression(1)}, {}}};
  Findings findings{all, all, no_reference, no_problem, true, {}, {fit_strength_envelopes(data)}};
  PictureBook book;
  std::map<std::string, std::string> admissible;
  for (const PageBlock& block : envelope_section(findings, book).blocks)
    for (const Table& table : block.tables)
      if (table.name == "envelopes")
        for (const auto& row : table.rows)
          admissible[row[0]] = row[1];
  EXPECT_EQ(admissible["intact, with σ_t"], "✓");
  EXPECT_EQ(admissible["a free, with σ_t"], "not determined: an interval reaches 0");
  EXPECT_EQ(admissible["a free, without σ_t"], "no more points than parameters: not drawn");
  EXPECT_EQ(admissible["Mohr–Coulomb"], "not determined: an interval reaches 0");
}

TEST(Envelope, OfPointsThatAreSteepestUnderTheFirstPressureNamesSmoothPlatens)
{
  const auto says_so = [](const std::string& friction, const double strength_at_10_mpa,
                          const std::vector<VariantSetting>& settings = {},
                          const SeriesKind kind = SeriesKind::specimens) {
    const StrengthData data{{{0.0, 160e6}, {10e6, strength_at_10_mpa}, {30e6, 480e6}}, 160e6, 10e6};
    FinishedTest test = compression(1);
    test.settings = settings;
    Series series{"rock", kind, {}, {test}, {}};
    series.made_by.input = {{"Tests", "Platen friction", friction}};
    const std::vector<Series> all{series};
    Findings findings{all, all, no_reference, no_problem, true, {}, {fit_strength_envelopes(data)}};
    PictureBook book;
    for (const PageBlock& block : envelope_section(findings, book).blocks)
      for (const std::string& paragraph : block.paragraphs)
        if (paragraph.find("Tests/Platen friction") != std::string::npos)
          return true;
    return false;
  };
  // From tension to the uniaxial test the points rise by 160 over 10; up to the first pressure by 18 or by 14 over one.
  EXPECT_TRUE(says_so("0", 340e6));
  EXPECT_FALSE(says_so("0", 300e6));
  EXPECT_FALSE(says_so("0.2", 340e6));
  EXPECT_FALSE(says_so("0", 340e6, {{"Tests/Platen friction", "0.1"}}));
  EXPECT_TRUE(says_so("0.2", 340e6, {{"Tests/Platen friction", "0"}}));
  EXPECT_FALSE(says_so("0", 340e6, {}, SeriesKind::finite_elements)); // its platens are those of Sample/Platens
}

TEST(PictureBook, NumbersPicturesOfOneName)
{
  PictureBook book;
  Picture picture;
  picture.name = "curves";
  const auto places = book.keep({picture, picture, picture});
  ASSERT_EQ(places.size(), 3u);
  EXPECT_EQ(places[0].picture.name, "curves");
  EXPECT_EQ(places[1].picture.name, "curves_2");
  EXPECT_EQ(places[2].picture.name, "curves_3");
}

/// Pictures of the strength alone.
std::vector<Picture> strength_pictures(const std::vector<Series>& all)
{
  auto pictures = study_pictures(all);
  std::erase_if(pictures, [](const Picture& picture) { return picture.name.find("_strength") == std::string::npos; });
  return pictures;
}

TEST(StudyPicture, ShowsResultsOverTheNumberThatVaries)
{
  const auto series_at = [](const std::string& label, const std::vector<VariantSetting>& settings,
                            const std::vector<double>& strengths) {
    Series series{label, SeriesKind::specimens, {}, {}, {}};
    for (const double strength : strengths)
      {
        series.tests.push_back(compression(1));
        series.tests.back().settings = settings;
        series.tests.back().results.peak_stress = {strength, ""};
      }
    return series;
  };
  const auto live_of = [](const std::vector<Series>& all) {
    const auto pictures = study_pictures(all);
    EXPECT_FALSE(pictures.empty());
    return pictures.empty() ? nlohmann::json() : nlohmann::json::parse(pictures.front().live());
  };
  const std::vector<Series> all{series_at("a", {{"Flat joint/Friction", "0.2"}}, {100e6, 120e6}),
                                series_at("b", {{"Flat joint/Friction", "0.5"}}, {150e6})};
  const auto strength = live_of(all);
  ASSERT_EQ(strength["lines"].size(), 3u); // means, marks and bars of one test
  EXPECT_EQ(strength["lines"][0]["points"], nlohmann::json::parse("[[0.2, 110.0], [0.5, 150.0]]"));
  // The deviation of two values that are 20 MPa apart is 14.14 MPa; one value has none.
  ASSERT_EQ(strength["lines"][2]["points"].size(), 3u);
  EXPECT_NEAR(strength["lines"][2]["points"][1][1], 110.0 + 14.142, 0.01);

  // A second entry that varies, by words: lines of its own. A number in two units, or one value: no picture.
  const std::vector<Series> crossed{
    series_at("a", {{"Flat joint/Friction", "0.2"}, {"Specimen/Joint law", "flat joint"}}, {100e6}),
    series_at("b", {{"Flat joint/Friction", "0.5"}, {"Specimen/Joint law", "flat joint"}}, {150e6}),
    series_at("c", {{"Flat joint/Friction", "0.2"}, {"Specimen/Joint law", "parallel bond"}}, {90e6}),
    series_at("d", {{"Flat joint/Friction", "0.5"}, {"Specimen/Joint law", "parallel bond"}}, {80e6})};
  EXPECT_EQ(live_of(crossed)["lines"][2]["label"], "Uniaxial compression, Joint law = parallel bond");
  EXPECT_TRUE(study_pictures({all[0]}).empty());
  EXPECT_TRUE(study_pictures({series_at("a", {{"Specimen/Width", "20 mm"}}, {100e6}),
                              series_at("b", {{"Specimen/Width", "3 cm"}}, {100e6})})
                .empty());

  // Two entries in step: one picture over the first, one line; a third that falls while they grow goes along too.
  const std::vector<Series> in_step{
    series_at("a", {{"Flat joint/Friction", "0.2"}, {"Flat joint/Modulus", "50 GPa"}, {"Specimen/Width", "3 cm"}},
              {80e6}),
    series_at("b", {{"Flat joint/Friction", "0.4"}, {"Flat joint/Modulus", "70 GPa"}, {"Specimen/Width", "2 cm"}},
              {90e6}),
    series_at("c", {{"Flat joint/Friction", "0.5"}, {"Flat joint/Modulus", "90 GPa"}, {"Specimen/Width", "1 cm"}},
              {95e6})};
  const auto of_step = strength_pictures(in_step);
  ASSERT_EQ(of_step.size(), 1u);
  EXPECT_EQ(of_step[0].name, "study_Flat_joint_Friction_strength");
  EXPECT_TRUE(has(of_step[0].caption, "; along with it goes Flat joint/Modulus, Specimen/Width"));
  EXPECT_EQ(nlohmann::json::parse(of_step[0].live())["lines"][0]["points"],
            nlohmann::json::parse("[[0.2, 80.0], [0.4, 90.0], [0.5, 95.0]]"));
  EXPECT_EQ(nlohmann::json::parse(of_step[0].live())["lines"][0]["label"], "Uniaxial compression");

  // A table of samples, in which no two agree in an entry: points without lines, over each.
  const std::vector<Series> samples{
    series_at("a", {{"Flat joint/Friction", "0.2"}, {"Flat joint/Modulus", "70 GPa"}}, {80e6}),
    series_at("b", {{"Flat joint/Friction", "0.4"}, {"Flat joint/Modulus", "50 GPa"}}, {90e6}),
    series_at("c", {{"Flat joint/Friction", "0.5"}, {"Flat joint/Modulus", "60 GPa"}}, {95e6})};
  const auto of_samples = strength_pictures(samples);
  ASSERT_EQ(of_samples.size(), 2u);
  for (const Picture& picture : of_samples)
    {
      const auto lines = nlohmann::json::parse(picture.live())["lines"];
      ASSERT_EQ(lines.size(), 1u); // marks
      EXPECT_EQ(lines[0]["points"].size(), 3u);
    }
}

// Tension and compression under eight pressures: nine lines are more than a picture takes.
TEST(StudyPicture, OfManyTestsShowsEachKindByItself)
{
  std::vector<Series> all;
  for (const char* const friction : {"0.2", "0.5"})
    {
      Series series{friction, SeriesKind::specimens, {}, {}, {}};
      for (double pressure = 0.0; pressure < 9.0; ++pressure)
        {
          FinishedTest test = compression(1);
          test.record.kind = pressure == 0.0 ? direct_tension.kind : triaxial_compression.kind;
          test.record.confining_pressure = 1e6 * pressure;
          test.settings = {{"Flat joint/Friction", friction}};
          test.results.peak_stress = {1e6 * (100.0 + pressure), ""};
          series.tests.push_back(test);
        }
      all.push_back(series);
    }
  const auto pictures = strength_pictures(all);
  ASSERT_EQ(pictures.size(), 2u);
  EXPECT_EQ(pictures[0].name, "study_Flat_joint_Friction_strength_direct_tension");
  EXPECT_EQ(pictures[1].name, "study_Flat_joint_Friction_strength_triaxial_compression");
  EXPECT_TRUE(has(pictures[1].caption, "; 6 of 8 lines, all are in tests.csv"));
  const auto lines = nlohmann::json::parse(pictures[1].live())["lines"];
  ASSERT_EQ(lines.size(), 2u * 6u); // means and marks
  EXPECT_EQ(lines[0]["label"], "Triaxial compression, 1 MPa");
  EXPECT_EQ(lines[10]["label"], "Triaxial compression, 8 MPa");
}

// gnuplot reckons 8.4 px for a letter and 53 px beside it, and 713 px hold all columns: 204 px for labels of 18 letters, so that
// six stand in columns of five, and 523 px for labels of 56, so that they stand in one.
TEST(EnvelopePicture, GivesLongLabelsOfManySeriesAKeyOfMoreRows)
{
  const auto picture_of = [](const std::string& label) {
    std::vector<Series> all;
    for (const char* const n : {"1", "2", "3", "4", "5", "6"})
      {
        FinishedTest one = compression(1), two = compression(2);
        one.results.peak_stress = {100e6, ""};
        two.results.peak_stress = {110e6, ""};
        all.push_back({label + n, SeriesKind::specimens, {}, {one, two}, {}});
      }
    std::vector<StrengthEnvelopes> envelopes;
    for (const Series& series : all)
      envelopes.push_back(fit_strength_envelopes(strength_data(series.tests)));
    return combined_envelope_picture({all, envelopes, std::nullopt}).at(0);
  };
  const Picture brief = picture_of("law ");
  const Picture verbose = picture_of("Specimen/Joint law = softening flat joint ");
  EXPECT_TRUE(has(brief.script(), "set key vertical maxrows 5"));
  const auto entries = [](const Picture& picture) {
    const auto& series = picture.panels.at(0).series;
    return std::count_if(series.begin(), series.end(),
                         [](const ChartSeries& one) { return !one.points.empty() && one.goes_with.empty(); });
  };
  ASSERT_EQ(entries(brief), 6);
  EXPECT_TRUE(has(verbose.script(), "set key vertical maxrows 6"));
  EXPECT_EQ(verbose.height, brief.height + 23);
}

// τ = c + σ_n tan φ touches all circles of σ_1 = q_u + N σ_3: φ = asin((N - 1)/(N + 1)), c = q_u/(2 √N).
TEST(TouchingPoint, OfALineLiesOnMohrAndCoulombs)
{
  const double slope = 4.0;
  const double uniaxial = 100e6;
  const double friction_angle = std::asin((slope - 1.0) / (slope + 1.0));
  const double cohesion = uniaxial / (2.0 * std::sqrt(slope));
  const auto line = [&](const double sigma_3) { return uniaxial + slope * sigma_3; };
  for (const double sigma_3 : {0.0, 5e6, 40e6})
    {
      const auto [normal, shear] = touching_point(line, sigma_3);
      // The derivative is a difference over some Pa: eight digits are left of sixteen.
      EXPECT_NEAR(shear, cohesion + normal * std::tan(friction_angle), 1e-7 * uniaxial);
      EXPECT_NEAR(std::hypot(normal - 0.5 * (line(sigma_3) + sigma_3), shear), 0.5 * (line(sigma_3) - sigma_3),
                  1e-7 * uniaxial);
    }
}

TEST(ResidualStrength, IsThatOfAPlateauAlone)
{
  // To 120 MPa at row 20, down to 40 MPa at row 40, level to row 80; under 10 MPa. Rows 60 to 80 are the last third.
  const auto pressed = [](const double last_slope) {
    FinishedTest test = compression(1);
    test.record.kind = triaxial_compression.kind;
    test.record.confining_pressure = 10e6;
    test.record.curve.clear();
    for (int k = 0; k <= 80; ++k)
      {
        CurveSample row;
        row.axial_strain = -1e-4 * k;
        row.axial_stress = -(k <= 20   ? 10e6 + 5.5e6 * k
                             : k <= 40 ? 120e6 - 4e6 * (k - 20)
                                       : 40e6 - last_slope * (k - 40));
        test.record.curve.push_back(row);
      }
    return test;
  };
  EXPECT_NEAR(*residual_strength(pressed(0.0).record).value, 40e6, 1.0);
  // The halves of the third differ by 10 rows' fall: 8 MPa are below, 15 MPa above a tenth of 110 MPa.
  EXPECT_TRUE(residual_strength(pressed(0.8e6).record).value);
  EXPECT_EQ(residual_strength(pressed(1.5e6).record).reason, "the stress was still changing when the test ended");
  EXPECT_EQ(residual_strength(compression(1).record).reason, "too few rows after the peak");

  Series series{"rock", SeriesKind::specimens, {}, {pressed(0.0), pressed(1.5e6)}, {}};
  ASSERT_EQ(residual_points(series).size(), 1u); // one of two tests
  EXPECT_NEAR(residual_points(series).front().sigma_1, 40e6, 1.0);
  series.tests.push_back(pressed(1.5e6));
  EXPECT_TRUE(residual_points(series).empty()); // one of three
}

std::size_t widest_line(const std::string& text)
{
  std::size_t widest = 0;
  std::istringstream lines(text);
  for (std::string line; std::getline(lines, line);)
    widest = std::max(
      widest, std::size_t(std::count_if(line.begin(), line.end(), [](const char c) { return (c & 0xC0) != 0x80; })));
  return widest;
}

TEST(TerminalText, OfAComparisonFitsAndLeavesOutWhatIsEmpty)
{
  const ReferenceValue measured{161.5, 160.0, 170.0};
  std::vector<ComparisonRow> rows{
    {"uniaxial compressive strength", "MPa", 1, Statistics{3, 176.0, 5.1, 2.9, 12.7}, std::nullopt, measured},
    {"Young's modulus, tangent 40-60 % of peak", "GPa", 1, Statistics{3, 55.5, 0.4, 0.2, 1.0}, std::nullopt,
     std::nullopt}};
  EXPECT_FALSE(has(as_text(rows, std::nullopt), "reference model"));
  // There is room for 80 - 2 - 11 - 2 - 22 = 43 characters of a heading; the second has 46.
  EXPECT_TRUE(has(as_text(rows, std::nullopt), "uniaxial compressive strength [MPa] "));
  EXPECT_TRUE(has(as_text(rows, std::nullopt), "\n  [GPa]\n"));
  rows[0].model = ReferenceValue{167.4, std::nullopt, std::nullopt};
  const std::string text = as_text(rows, std::nullopt);
  EXPECT_TRUE(has(text, "reference model"));
  EXPECT_LE(widest_line(text), 80u) << text;
  EXPECT_TRUE(has(text, "\n  40-60 % of peak [GPa]\n"));
}

TEST(Comparison, NamesPropertiesOfTheRockThatWereNotTested)
{
  Reference reference = granite(120.0, 130.0);
  reference.experiment.values["tensile_strength_MPa"] = {9.5, std::nullopt, std::nullopt};
  reference.experiment.values["strength_at_30_MPa"] = {400.0, std::nullopt, std::nullopt};
  reference.experiment.values["density_kg_per_m3"] = {2700.0, std::nullopt, std::nullopt};
  const auto rows = compare({compression(3), compression(4, 1.1)}, reference);
  EXPECT_EQ(properties_without_a_test(rows, reference),
            (std::vector<std::string>{"strength_at_30_MPa", "tensile_strength_MPa"}));
  EXPECT_EQ(
    verdict(rows, reference, "").points.back(),
    "Not tested here: the experiment's strength_at_30_MPa, tensile_strength_MPa; Tests/List and Tests/Confinements "
    "add tests.");
  EXPECT_TRUE(has(as_text(rows, reference), "Not tested here: the experiment's strength_at_30_MPa"));
  EXPECT_TRUE(properties_without_a_test(rows, std::nullopt).empty());
}

TEST(Comparison, SaysWhyATestOfAPropertyHasNoFigureOfIt)
{
  // A half disc with a notch for which its formula does not hold.
  Reference reference = granite(120.0, 130.0);
  reference.experiment.values["fracture_toughness_MPa_sqrt_m"] = {1.3, std::nullopt, std::nullopt};
  const FinishedTest bent = notched(semicircular_bending.kind, false);
  ASSERT_FALSE(bent.results.fracture_toughness.value);
  const auto rows = compare({bent}, reference);
  const auto untested = properties_without_a_test(rows, reference);
  EXPECT_EQ(std::find(untested.begin(), untested.end(), "fracture_toughness_MPa_sqrt_m"), untested.end());
  const auto sentences = sentences_on_missing(rows, reference);
  ASSERT_FALSE(sentences.empty());
  EXPECT_EQ(sentences.front().rfind(
              "No figure of fracture toughness, semicircular bending: the body lies outside of the range", 0),
            0u)
    << sentences.front();
  EXPECT_TRUE(has(as_text(rows, reference), "No figure of fracture toughness"));
  // The verdict says it too where nothing else can be compared.
  EXPECT_EQ(verdict(rows, reference, "").points.front(), sentences.front());
  // The same of a body that could not be set up.
  FinishedTest refused;
  refused.record.kind = semicircular_bending.kind;
  refused.record.failure = "the roller has no bonded grain";
  EXPECT_EQ(sentences_on_missing(compare({refused}, reference), reference).front(),
            "No figure of fracture toughness, semicircular bending: the roller has no bonded grain.");
}

TEST(StrengthTable, HasTheToughnessOfNotchedBodiesOnly)
{
  FinishedTest bent = compression(3);
  bent.results.fracture_toughness = {1.234e6, ""};
  bent.results.fracture_energy = {45.67, ""};
  std::vector<Series> all(1);
  all[0].tests = {compression(3)};
  const Findings findings{all, all, no_reference, no_problem, true, {}, {}};
  EXPECT_EQ(strength_table(findings).header.size(), 7u);
  all.emplace_back().tests = {bent};
  const Table table = strength_table(findings);
  ASSERT_EQ(table.header.size(), 9u);
  EXPECT_EQ(table.header[7], "fracture toughness [MPa √m]");
  EXPECT_EQ(table.rows.at(0)[7], "–");
  EXPECT_EQ(table.rows.at(1)[7], "1.234");
  EXPECT_EQ(table.rows.at(1)[8], "45.7");
}

TEST(TrustChecks, MeasureTheLigamentInGrains)
{
  // 20 mm wide at 10 mean diameters: a ligament of 9 mm is four and a half of them.
  FinishedTest bent = compression(3);
  bent.record.size = {0.020, 0.010, 0.0};
  bent.record.specimen.resolution = 10.0;
  const auto ligament = [&] {
    const auto checks = trust_checks({&bent}, SeriesKind::specimens);
    const auto found = std::find_if(checks.begin(), checks.end(), [](const TrustCheck& check) {
      return check.measure.name == "ligament_over_mean_diameter";
    });
    return found == checks.end() ? std::nullopt : std::optional(*found);
  };
  EXPECT_FALSE(ligament());
  bent.record.notch = notched(three_point_bending.kind, true).record.notch;
  ASSERT_TRUE(ligament());
  EXPECT_NEAR(ligament()->worst, 4.5, 1e-12);
  EXPECT_EQ(ligament()->n_out, 1u);
}

TEST(Comparison, TakesTheModulusAndTheRatioThatTheReferenceHas)
{
  Reference reference = granite(120.0, 130.0);
  reference.experiment.values["poissons_ratio"] = {0.2, 0.1, 0.3};
  const auto compared_in = [&](const ElasticFigures& elastic) {
    std::vector<std::string> properties;
    for (const ComparisonRow& row : compare({compression(3)}, reference, elastic))
      if (row.experiment && (row.key == "youngs_modulus_GPa" || row.key == "poissons_ratio"))
        properties.push_back(row.property);
    return properties;
  };
  EXPECT_EQ(compared_in({}), (std::vector<std::string>{"Young's modulus, tangent 40-60 % of peak",
                                                       "Poisson's ratio, secant at 50 % of peak"}));
  EXPECT_EQ(compared_in({"initial", "initial"}),
            (std::vector<std::string>{"Young's modulus, initial", "Poisson's ratio, initial"}));
  EXPECT_EQ(compared_in({"secant", "secant"}), (std::vector<std::string>{"Young's modulus, secant at 50 % of peak",
                                                                         "Poisson's ratio, secant at 50 % of peak"}));
  // Properties that are not compared do not count as not tested.
  EXPECT_TRUE(
    properties_without_a_test(compare({compression(3)}, reference, {"initial", "initial"}), reference).empty());
}

TEST(PageText, OfNumbersHasTheirFiguresAndNoSignOfZero)
{
  EXPECT_EQ(text::significant(119.04, 3), "119");
  EXPECT_EQ(text::significant(777.0, 3), "777");
  EXPECT_EQ(text::significant(1234.0, 3), "1230");
  EXPECT_EQ(text::significant(99.96, 3), "100"); // not 100.0
  EXPECT_EQ(text::significant(15.26, 3), "15.3");
  EXPECT_EQ(text::significant(0.15, 3), "0.150");
  EXPECT_EQ(text::significant(-0.0004567, 2), "-0.00046");
  EXPECT_EQ(text::significant(0.0, 3), "0");
  EXPECT_EQ(text::number(-0.004, 2), "0.00");
  EXPECT_EQ(text::number(-0.04, 2), "-0.04");
  EXPECT_EQ(text::signed_percent(-0.0004), "+0.0 %");
  EXPECT_EQ(text::signed_percent(-0.012), "−1.2 %");
  EXPECT_EQ(text::sentence("the targets were missed"), "The targets were missed.");
  EXPECT_EQ(text::sentence("All were reached."), "All were reached.");
}

/// Record of two targets, of which the second is Poisson's ratio; three samples of two parameters.
CalibrationRecord calibration_record()
{
  CalibrationRecord record;
  record.rock = "granite: of somewhere";
  record.statement = "All targets were reached within 3 %.";
  record.elastic = {"initial", "initial"};
  record.targets = {{"uniaxial_compressive_strength", "uniaxial compressive strength", "Pa", 161.5e6, 5e6, 163.04e6,
                     1.234e6, 0.00954, 12.0, TargetVerdict::reached},
                    {"poissons_ratio", "Poisson's ratio, initial", "1", 0.15, 0.01, 0.15, 0.002, 0.0, 12.0,
                     TargetVerdict::not_decided}};
  record.parameters = {{"bond_cohesion", "bond cohesion", "Pa", 777.0e6, 600.4e6, 413.0e6, 994.0e6, "bounded",
                        "The bond cohesion is bounded."},
                       {"cohesion_ratio", "bond cohesion over tensile strength", "1", 18.79, 20.0, 12.1, 36.9,
                        "bounded", "The ratio is bounded."}};
  record.predictions = {{"crack_damage_stress", "crack damage stress", "Pa", 150e6, 119.0e6, 192.0e6}};
  record.sensitivities = {{"crack_damage_stress", "cohesion_ratio", 0.92, 0.95},
                          {"crack_damage_stress", "installation_gap_ratio", -0.0006, 0.003},
                          {"poissons_ratio", "cohesion_ratio", 0.1, 0.2}};
  record.sampled = {"bond_cohesion_Pa", "cohesion_ratio"};
  record.samples = {{600e6, 700e6, 800e6}, {15.0, 20.0, 22.0}};
  return record;
}

TEST(CalibrationSection, HasTitlesAndNoMoreFiguresThanAreKnown)
{
  PictureBook book;
  const PageSection section = calibration_section(calibration_record(), book);
  ASSERT_EQ(section.blocks.size(), 2u);
  const std::vector<Table>& tables = section.blocks[0].tables;
  ASSERT_EQ(tables.size(), 2u);
  EXPECT_EQ(tables[0].rows[0], (std::vector<std::string>{"uniaxial compressive strength [MPa]", "161.5", "163.0", "1.2",
                                                         "+1.0 %", "12", "reached"}));
  EXPECT_EQ(tables[0].rows[1].back(), "not decided");
  EXPECT_EQ(tables[1].rows[0],
            (std::vector<std::string>{"bond cohesion [MPa]", "777", "600", "413 to 994", "bounded"}));
  ASSERT_EQ(section.blocks[0].pictures.size(), 1u) << "the pairs do not stand in their section";
  EXPECT_TRUE(section.blocks[0].pictures[0].picture.caption.ends_with('.'));
  const std::vector<Table>& more = section.blocks[1].tables;
  ASSERT_EQ(more.size(), 2u);
  EXPECT_EQ(more[0].rows[0], (std::vector<std::string>{"crack damage stress [MPa]", "150", "119 to 192"}));
  EXPECT_EQ(more[1].rows, (std::vector<std::vector<std::string>>{
                            {"crack damage stress", "bond cohesion over tensile strength", "0.92", "0.95"},
                            {"crack damage stress", "installation gap ratio", "0.00", "0.00"},
                            {"Poisson's ratio, initial", "bond cohesion over tensile strength", "0.10", "0.20"}}));
  EXPECT_TRUE(has(more[1].caption, "Poisson's ratio less that of intact cells"));
}

TEST(CalibrationSection, OfWhatWasNotTestedSaysWhatIsPredicted)
{
  CalibrationRecord record = calibration_record();
  record.statement = "these targets cannot be reached together";
  for (auto& target : record.targets)
    {
      target.standard_error.reset();
      target.n_packings = 0.0;
    }
  for (auto& parameter : record.parameters)
    parameter = {parameter.name, parameter.title, parameter.unit, parameter.best, {}, {}, {}, "", ""};
  record.predictions.clear();
  record.sampled.clear();
  record.samples.clear();
  PictureBook book;
  const PageSection section = calibration_section(record, book);
  const PageBlock& block = section.blocks.at(0);
  EXPECT_EQ(block.headline, "These targets cannot be reached together.");
  EXPECT_TRUE(block.points.empty());
  EXPECT_TRUE(block.pictures.empty());
  EXPECT_EQ(block.tables[0].header[2], "predicted");
  EXPECT_EQ(block.tables[0].rows[0][2], "163.0");
  EXPECT_EQ(block.tables[0].rows[0][5], "–");
  EXPECT_EQ(block.tables[1].header[1], "nearest");
  EXPECT_EQ(block.tables[1].rows[0], (std::vector<std::string>{"bond cohesion [MPa]", "777", "–", "–", ""}));
  ASSERT_EQ(section.blocks.size(), 2u) << "the Sobol indices are missing";

  const TemporaryFolder folder;
  EXPECT_TRUE(write_report(record, folder.path()).empty());
  const std::string page = content(folder.path() / "report.html");
  EXPECT_TRUE(has(page, "granite: calibration", "These targets cannot be reached together.", "predicted", "nearest"));
  EXPECT_TRUE(has(content(folder.path() / "tables/calibration_targets.csv"), "predicted"));
}

TEST(Report, OfACalibrationBeginsWithItsStatementAndHasThePairsBelow)
{
  // The initial modulus of 60 GPa lies in its range; so does the initial ratio of 0.2.
  Reference reference = granite(100.0, 130.0);
  reference.rock = "granite";
  reference.experiment.values["youngs_modulus_GPa"] = {60.0, 55.0, 65.0};
  reference.experiment.values["poissons_ratio"] = {0.2, 0.15, 0.25};
  Series series;
  series.label = "answer";
  series.tests = {compression(3), compression(4), compression(5)};
  ReportInput input;
  input.all = {series};
  input.envelopes = {fit_strength_envelopes(strength_data(series.tests))};
  input.reference = reference;
  input.calibration = calibration_record();
  const TemporaryFolder folder;
  write_report(input, folder.path(), {[] { return true; }, [](std::size_t, std::size_t) {}}); // without pictures
  const std::string page = content(folder.path() / "report.html");
  const auto place = [&](const std::string& words) {
    const std::size_t at = page.find(words);
    EXPECT_NE(at, std::string::npos) << words;
    return at;
  };
  const std::size_t decision =
    place("Not decided. Poisson&apos;s ratio needs more packings; 1 of 2 targets is reached.");
  const std::size_t first_line = place(
    "Yes. Uniaxial compressive strength, Young&apos;s modulus and Poisson&apos;s ratio lie within the measured ranges "
    "(3 specimens).");
  place("Young&apos;s modulus, initial</span> <b><span class=\"mark\">✓</span> 60.0");
  place("Young&apos;s modulus is taken to be the initial one and Poisson&apos;s ratio the initial one");
  EXPECT_LT(place("Were the targets reached?"), decision);
  EXPECT_LT(decision, place("target 161.5 MPa, +1.0 %; reached</span>"));
  EXPECT_LT(decision, place("Micro-parameters that agree with the tests"));
  EXPECT_LT(place("Micro-parameters that agree with the tests"), first_line);
}

TEST(CalibrationSection, BeginsWithTheDecisionInWordsAndATileForEachTarget)
{
  CalibrationRecord record = calibration_record();
  record.tolerance = 0.03;
  PictureBook book;
  const auto headline = [&](const TargetVerdict strength, const TargetVerdict ratio) {
    record.targets[0].verdict = strength;
    record.targets[1].verdict = ratio;
    return calibration_section(record, book).blocks.at(0).headline;
  };
  using enum TargetVerdict;
  EXPECT_EQ(headline(reached, reached), "Reached. All 2 targets lie within 3 % of the laboratory's value.");
  EXPECT_EQ(headline(missed, reached),
            "Missed. Uniaxial compressive strength is more than 3 % off; 1 of 2 targets is reached.");
  EXPECT_EQ(
    headline(missed, missed),
    "Missed. Uniaxial compressive strength and Poisson's ratio are more than 3 % off; 0 of 2 targets are reached.");
  EXPECT_EQ(headline(missed, not_decided),
            "Missed. Uniaxial compressive strength is more than 3 % off. Poisson's ratio needs more "
            "packings; 0 of 2 targets are reached.");
  EXPECT_EQ(headline(reached, not_decided),
            "Not decided. Poisson's ratio needs more packings; 1 of 2 targets is reached.");
  const std::vector<Tile> tiles = calibration_section(record, book).blocks.at(0).tiles;
  ASSERT_EQ(tiles.size(), 2u);
  EXPECT_EQ(tiles[0].value, "163.0 MPa");
  EXPECT_EQ(tiles[0].n, 12u);
  EXPECT_EQ(tiles[0].mark, TileMark::good);
  EXPECT_NEAR(tiles[0].low.value(), 161.5e6 * 0.97, 1.0);
  // Half of the 95 % interval: Student's t of eleven degrees of freedom is 2.201.
  EXPECT_NEAR(tiles[0].deviation, 2.201 * 1.234e6, 1e3);
  EXPECT_EQ(tiles[1].mark, TileMark::not_decided);
}

/// A run of variants of two entries: friction adds 50 MPa, the modulus nothing.
std::vector<Series> two_entries()
{
  std::vector<Series> all;
  for (const char* const friction : {"0.2", "0.5"})
    for (const char* const modulus : {"50 GPa", "60 GPa", "70 GPa"})
      {
        Series series{fmt::format("Friction = {}, Modulus = {}", friction, modulus), SeriesKind::specimens, {}, {}, {}};
        series.tests = {compression(1)};
        FinishedTest& test = series.tests.front();
        test.name = fmt::format("uniaxial_compression_{}_seed_1", all.size());
        test.variant = series.label;
        test.settings = {{"Flat joint/Friction", friction}, {"Flat joint/Modulus", modulus}};
        test.results.peak_stress = {friction == std::string("0.2") ? 100e6 : 150e6, ""};
        test.results.energy_imbalance_over_work = 0.02;
        all.push_back(series);
      }
  return all;
}

std::string page_of(const std::vector<Series>& all)
{
  ReportInput input;
  input.all = all;
  for (const Series& series : all)
    input.envelopes.push_back(fit_strength_envelopes(strength_data(series.tests)));
  const TemporaryFolder folder;
  write_report(input, folder.path(), {[] { return true; }, [](std::size_t, std::size_t) {}}); // without pictures
  return content(folder.path() / "report.html");
}

TEST(Report, OfAStudyBeginsWithItsEffectsAndItsMap)
{
  const std::string page = page_of(two_entries());
  const std::size_t study = page.find("<section id=\"study\">");
  ASSERT_NE(study, std::string::npos);
  EXPECT_EQ(page.find("<section "), study) << "the page begins elsewhere";
  EXPECT_TRUE(has(
    page,
    "Uniaxial compression, strength [MPa]: with Friction from 0.2 to 0.5 it goes from 100 to 150 (+50.0 %); Modulus has no "
    "effect."));
  const std::size_t map = page.find("over Flat joint/Friction and Flat joint/Modulus: mean over the seeds");
  EXPECT_LT(page.find("<div class=\"beside\">", study), map);
  EXPECT_LT(map, page.find("<details>", study)) << "the map is folded";
  EXPECT_TRUE(has(page, "<th scope=\"row\">Uniaxial compression: strength [MPa]</th><td>100 to 150 (+50.0 %)</td>"
                        "<td>no effect</td>"));
  // Folded parts do not stand on paper, and a warning on all stands once.
  EXPECT_TRUE(has(page, "<body class=\"brief-on-paper\">"));
  EXPECT_EQ(times(page, "Only 1 specimen: "), 1u);
  EXPECT_EQ(times(page, "take 3 seeds or more (so in 6 of 6 series)."), 1u);
  EXPECT_EQ(times(page, "Out of bounds in 6 of 6 tests: energy imbalance over boundary work"), 1u);
}

TEST(Report, OfOneEntrySaysWhereAResultIsHighestBetweenItsEnds)
{
  std::vector<Series> all = two_entries();
  all.erase(all.begin() + 3, all.end());
  const char* const moduli[] = {"50 GPa", "60 GPa", "70 GPa"};
  for (std::size_t k = 0; k < all.size(); ++k)
    {
      all[k].tests.front().settings = {{"Flat joint/Modulus", moduli[k]}};
      all[k].tests.front().results.peak_stress = {k == 1 ? 130e6 : 100e6, ""};
    }
  EXPECT_TRUE(has(page_of(all),
                  "strength [MPa]: with Modulus from 50 to 70 GPa it goes from 100 to 100 (+0.0 %); 130 at 60 GPa."));
}

TEST(Trust, OfManySeriesCountsWhatIsAlikeButForNamesAndNumbers)
{
  std::vector<Series> all = two_entries();
  for (std::size_t k = 0; k < 3; ++k)
    all[k].tests.front().record.failure = fmt::format("no grains: {} were packed", k);
  const auto sentences = grouped_warnings(all);
  ASSERT_EQ(sentences.size(), 3u);
  EXPECT_EQ(sentences[0], "uniaxial_compression_0_seed_1 could not be finished: no grains: 0 were packed (so in 3 of 6 "
                          "series).");
  EXPECT_TRUE(sentences[1].ends_with("(so in 6 of 6 series).")) << sentences[1];
  EXPECT_TRUE(sentences[2].starts_with("Out of bounds in 3 of 3 tests: energy imbalance")) << sentences[2];
}

TEST(Trust, SaysOnceWhatHoldsForSeveralTests)
{
  std::vector<Series> all{{"out", SeriesKind::specimens, {}, {compression(1), compression(2), compression(3)}, {}}};
  for (const std::size_t k : {0u, 2u})
    all[0].tests[k].record.failure = "the walls cannot hold 40000 MPa";
  const auto sentences = warnings(all[0]);
  EXPECT_EQ(sentences.front(),
            fmt::format("{} could not be finished: the walls cannot hold 40000 MPa. The same holds for "
                        "{}.",
                        all[0].tests[0].name, all[0].tests[2].name));
  EXPECT_EQ(times(joined(sentences), "cannot hold"), 1u);
}

// Texts of the user: a heading, a name in tables and keys, a line under the heading and one at the top of each sheet.
TEST(Report, BearsTheTextsOfItsUser)
{
  std::vector<Series> all{{"out", SeriesKind::specimens, {}, {compression(1), compression(2), compression(3)}, {}}};
  const std::string without = page_of(all);
  EXPECT_FALSE(has(without, "<div class=\"paper-head\">"));
  for (const char* const entry : {"Title", "Client", "Specimen", "Author", "Date"})
    all[0].made_by.input.push_back({"Report", entry, "none"});
  EXPECT_EQ(page_of(all), without) << "an empty text changes the page";
  const auto write = [&](const std::size_t k, const char* const text) { all[0].made_by.input[k].value = text; };
  write(0, "Tunnel <b>7</b>");
  write(1, "Nagra & Co");
  write(2, "BS06-3");
  write(4, "2026-11-29");
  const std::string page = page_of(all);
  EXPECT_TRUE(has(page, "<title>Tunnel &lt;b&gt;7&lt;/b&gt;</title>", "<h1>Tunnel &lt;b&gt;7&lt;/b&gt;</h1>",
                  "<p>Client: Nagra &amp; Co · Specimen: BS06-3 · Date: 2026-11-29</p>",
                  "<div class=\"paper-head\"><p>2026-11-29 · BS06-3</p></div>",
                  "<th scope=\"row\">Report</th><td>Client</td>"));
  EXPECT_FALSE(has(page, "<b>7")) << "a title became a part of the page";
  EXPECT_FALSE(has(page, "<td>Author</td>"));
  // Beside another run it is named by its title.
  all.push_back({"other", SeriesKind::specimens, {}, {compression(1)}, {}});
  EXPECT_TRUE(has(page_of(all), "</span>Tunnel &lt;b&gt;7&lt;/b&gt;</h3>"));
}

TEST(CalibrationRecord, KnowsWhichFiguresItsReferenceHasAndNeedsNoPosterior)
{
  const TemporaryFolder folder;
  folder.write("calibration.json", R"({"input": {"parameters": {"Calibration": {"Youngs modulus": "secant",
    "Poissons ratio": "initial"}}}, "rock": "granite", "statement": "s", "tolerance": 0.03, "targets": {},
    "parameters": {"modulus": {"title": "modulus", "unit": "Pa", "best": 50e9}}, "predictions": {},
    "sensitivities": {}})");
  const auto record = read_calibration(folder.path());
  ASSERT_TRUE(record);
  EXPECT_EQ(record->rock, "granite");
  EXPECT_EQ(record->elastic.youngs_modulus, "secant");
  EXPECT_EQ(record->elastic.poissons_ratio, "initial");
  ASSERT_EQ(record->parameters.size(), 1u);
  EXPECT_EQ(record->parameters[0].best, 50e9);
  EXPECT_FALSE(record->parameters[0].median);
  // A calibration with a posterior has its samples.
  folder.write("calibration.json", R"({"statement": "s", "tolerance": 0.03, "targets": {}, "parameters": {"modulus":
    {"title": "modulus", "unit": "Pa", "best": 50e9, "median": 51e9, "lower_90": 40e9, "upper_90": 60e9,
    "verdict": "determined", "sentence": "s"}}, "predictions": {}, "sensitivities": {}})");
  EXPECT_THROW(read_calibration(folder.path()), InputError);
  folder.write("posterior.csv", "modulus_Pa\n50e9\n52e9\n");
  EXPECT_EQ(read_calibration(folder.path())->samples, (std::vector<std::vector<double>>{{50e9, 52e9}}));
  EXPECT_EQ(read_calibration(folder.path())->elastic.youngs_modulus, "tangent"); // the default of the input
}

std::string calibration_of_strength(const std::string& of_file, const std::string& of_target)
{
  return R"({"statement": "All targets were reached within 3 % or within two standard errors.", "tolerance": 0.03, )" +
         of_file +
         R"("targets": {"tensile_strength": {"title": "tensile strength", "unit": "Pa", "target": 10e6,
    "target_standard_deviation": 1e5, )" +
         of_target + R"(}}, "parameters": {}, "predictions": {}, "sensitivities": {}})";
}

// Files of before there were verdicts called a target reached within two standard errors.
TEST(CalibrationRecord, JudgesAFileWithoutVerdictsByItsOwnMeans)
{
  const TemporaryFolder folder;
  const auto record = [&](const std::string& of_target, const std::string& of_file = "") {
    folder.write("calibration.json", calibration_of_strength(of_file, of_target));
    return *read_calibration(folder.path());
  };
  // Twelve packings: 2.201 standard errors to each side.
  CalibrationRecord read =
    record(R"("reached": 10.1e6, "standard_error": 0.08e6, "deviation": 0.01, "n_packings": 12)");
  EXPECT_EQ(read.verdict, TargetVerdict::reached) << "-0.8 to 2.8 %";
  EXPECT_EQ(read.statement, "All targets were reached within 3 %.");
  read = record(R"("reached": 10.1e6, "standard_error": 0.1e6, "deviation": 0.01, "n_packings": 12)");
  EXPECT_EQ(read.verdict, TargetVerdict::not_decided) << "-1.2 to 3.2 %";
  EXPECT_EQ(read.targets[0].verdict, TargetVerdict::not_decided);
  // A packing scatters by 3.46 %: 2.145 · 3.46 / √15 = 1.92 is less than the 2 that are left; √14 gives 2.0001.
  EXPECT_EQ(read.statement,
            "it is not decided whether all targets were reached within 3 %: tensile strength +1.0 ± 2.2 % "
            "(about 15 packings needed); raise Calibration/Most packings, test larger specimens or widen "
            "Calibration/Tolerance");
  read = record(R"("reached": 11e6, "standard_error": 0.2e6, "deviation": 0.1, "n_packings": 12)");
  EXPECT_EQ(read.verdict, TargetVerdict::missed) << "5.6 to 14.4 %";
  // Without tests the statement on what comes nearest stays.
  read = record(R"("reached": 11e6, "standard_error": null, "deviation": 0.1, "n_packings": 0)");
  EXPECT_EQ(read.verdict, TargetVerdict::missed);
  EXPECT_EQ(read.statement, "All targets were reached within 3 % or within two standard errors.");
  // Verdicts in the file itself hold.
  read = record(R"("reached": 11e6, "standard_error": 0.2e6, "deviation": 0.1, "n_packings": 12, "verdict": "reached")",
                R"("verdict": "reached", )");
  EXPECT_EQ(read.verdict, TargetVerdict::reached);
  EXPECT_EQ(read.targets[0].verdict, TargetVerdict::reached);
  folder.write("calibration.json", calibration_of_strength(R"("verdict": "met", )", R"("reached": 11e6,
    "standard_error": null, "deviation": 0.1, "n_packings": 0, "verdict": "met")"));
  EXPECT_THROW(read_calibration(folder.path()), InputError);
}

TEST(Comparison, HasTheRockConstantWhereTheReferenceDoes)
{
  // Two seeds on envelopes of 160 MPa with m_i = 24 and 26; a third was not tested without confinement.
  const auto at_20 = [](const double m) { return 20e6 + std::sqrt(m * 160e6 * 20e6 + 160e6 * 160e6); };
  const std::vector<FinishedTest> tests{pressed(0.0, 160e6, 1), pressed(20e6, at_20(24.0), 1), pressed(0.0, 160e6, 2),
                                        pressed(20e6, at_20(26.0), 2), pressed(20e6, 400e6, 3)};
  Reference reference = granite(150.0, 170.0);
  const auto row_of = [&]() -> std::optional<ComparisonRow> {
    for (const ComparisonRow& row : compare(tests, reference))
      if (row.key == "m_i")
        return row;
    return std::nullopt;
  };
  EXPECT_FALSE(row_of());
  reference.experiment.values["m_i"] = {28.0, std::nullopt, std::nullopt};
  ASSERT_TRUE(row_of());
  EXPECT_EQ(row_of()->ours->n, 2u);
  EXPECT_NEAR(row_of()->ours->mean, 25.0, 1e-3);
  EXPECT_NEAR(*row_of()->deviation(), 25.0 / 28.0 - 1.0, 1e-4);
}

TEST(TerminalText, OfATableHasHeadingsNoWiderThanItsColumns)
{
  const Table table{"stages",
                    "Stages",
                    {"stage", "confinement [MPa]", "n"},
                    {{"first", "5.0", "120"}, {"b", "10.0", "7"}}};
  EXPECT_EQ(as_text(table), "Stages\n"
                            "        confinement\n"
                            "stage         [MPa]     n\n"
                            "first           5.0   120\n"
                            "b              10.0     7\n");
}

TEST(TerminalText, OfEnvelopesFitsOnAScreen)
{
  const StrengthData data{{{0.0, 223.8e6}, {10e6, 358.4e6}, {30e6, 448.2e6}}, 223.8e6, 12.67e6};
  const std::string text = as_text(fit_strength_envelopes(data));
  const std::string tables = text.substr(0, text.find("s and a free, no σ_t: ")); // sentences are wrapped on a terminal
  EXPECT_LE(widest_line(tables), 80u) << tables;
  EXPECT_TRUE(has(text, "s and a free, no σ_t: no interval of m, s, a: "));
}

TEST(TerminalText, IsBrokenAtSpacesAndTablesAreNot)
{
  const std::string table = "tensile strength [MPa]                              10.01            9.07     9.53";
  EXPECT_EQ(wrapped("one σσσ two three\n  four five six seven\n\n" + table, 11),
            "one σσσ two\n  three\n  four five\n    six\n    seven\n\n" + table);
  EXPECT_EQ(wrapped("averylongword andanother", 10), "averylongword\n  andanother");
  EXPECT_EQ(wrapped("", 80), "");
}

TEST(Chart, IsDataThatEndsNoScript)
{
  Chart chart{.x = {.label = "</script><b>"}, .y = {.label = "q \xff [MPa]"}};
  chart.series.push_back({.label = "a \"b\"", .colour = "#000000", .points = {{1.0 / 3.0, 2e6}, gap, {-1e-9, 0.0}}});
  const std::string text = live::chart_data(chart);
  EXPECT_FALSE(has(text, "<"));
  const auto json = nlohmann::json::parse(text);
  EXPECT_EQ(json["x"], "</script><b>");
  EXPECT_EQ(json["y"], "q \xef\xbf\xbd [MPa]"); // the replacement character stands for what is no UTF-8
  EXPECT_EQ(json["lines"][0]["label"], "a \"b\"");
  const auto& points = json["lines"][0]["points"];
  ASSERT_EQ(points.size(), 3u);
  EXPECT_NEAR(points[0][0], 1.0 / 3.0, 5e-6); // five digits
  EXPECT_EQ(points[0][1], 2e6);
  EXPECT_TRUE(points[1].is_null());
  EXPECT_EQ(points[2][0], -1e-9);
}

TEST(Chart, HasNumbersOfAllSizes)
{
  EXPECT_EQ(live::number(1.23456789e-310).get<double>(), 1.2346e-310); // less than the least normal number, 2.2e-308
  EXPECT_EQ(live::number(5e-324).get<double>(), 5e-324);
  EXPECT_EQ(live::number(-123456.0).get<double>(), -123460.0);
  constexpr double largest = std::numeric_limits<double>::max();
  EXPECT_EQ(live::number(largest).get<double>(), largest); // 1.7977e308 is beyond it
  EXPECT_TRUE(live::number(std::nan("")).is_null());
}

// The pointer shows what the picture draws: the mean of two seeds, and each of them in a thin line.
TEST(Chart, OfCurvesHasTheirPoints)
{
  const std::vector<Series> all{{"rock", SeriesKind::specimens, {}, {compression(1), compression(2, 1.2)}, {}}};
  const auto pictures = curve_pictures(all).at(0).pictures;
  const auto json = nlohmann::json::parse(pictures.at(0).live());
  double highest = 0.0;
  std::size_t n_thin = 0;
  for (const auto& line : json["lines"])
    if (line["label"] == "rock, axial")
      for (const auto& point : line["points"])
        highest = std::max(highest, point[1].get<double>());
    else
      n_thin += line["goes_with"] == "rock, axial" && line["kind"] == "line";
  // 120 and 144 MPa at the same strain; 160 rows of the mean miss the corner by less than one of them, 1e-3 of 3e-3.
  EXPECT_NEAR(highest, 132.0, 1.0);
  EXPECT_EQ(n_thin, 2u);
}

// Axial strain goes to 3e-3; a piece that breaks off moves 20 times as far sideways.
TEST(Chart, OfStressEndsItsAxisWhereTheAxialStrainEnds)
{
  std::vector<Series> all{{"rock", SeriesKind::specimens, {}, {compression(1)}, {}}};
  const auto part = [&] { return nlohmann::json::parse(curve_pictures(all).at(0).pictures.at(0).live())["part"]; };
  EXPECT_TRUE(part().is_null());
  for (CurveSample& row : all[0].tests[0].record.curve)
    row.gauge_lateral_strain = 0.06;
  const auto limited = part();
  ASSERT_EQ(limited.size(), 4u);
  EXPECT_NEAR(limited[0], -3.0, 1e-3);
  EXPECT_NEAR(limited[1], 3.06, 1e-3);
  EXPECT_EQ(limited[2], 0.0);
}

TEST(CaptionOfCurves, NamesBandsWhereThereAreAny)
{
  const auto caption = [](const std::vector<FinishedTest>& tests) {
    const std::vector<Series> all{{"rock", SeriesKind::specimens, {}, tests, {}}};
    std::string text;
    const auto pictures = curve_pictures(all).at(0).pictures;
    for (const Picture& picture : pictures)
      text += picture.caption + "\n";
    return text;
  };
  EXPECT_FALSE(has(caption({compression(1)}), "band"));
  EXPECT_FALSE(has(caption({compression(1)}), "mean of the tests"));
  EXPECT_TRUE(has(caption({compression(1), compression(2)}), "bands: ± standard deviation"));
}

TEST(CrackMap, NumbersTheFirstJointsThatBroke)
{
  std::vector<Crack> cracks;
  const auto add = [&](const std::uint64_t joint, const std::uint64_t step, const double x) {
    Crack crack{};
    crack.joint = joint;
    crack.step = step;
    crack.centroid = {x, 0.01, 0.0};
    cracks.push_back(crack);
  };
  const double letter = 1e-3;
  add(4, 10, 0.010);
  add(4, 12, 0.010); // another segment of the same joint
  add(9, 20, 0.0101);
  add(2, 20, 0.030); // in the same step
  add(5, 30, 0.040);
  const MapPaper paper{{0.0, 0.0}, {0.1, 0.1}, letter};
  const auto first = number_first_cracks(cracks, paper);
  ASSERT_EQ(first.size(), 4u);
  const std::size_t expected[] = {1, 2, 2, 4};
  const double at[] = {0.010, 0.0101, 0.030, 0.040};
  for (std::size_t k = 0; k < 4; ++k)
    {
      EXPECT_EQ(first[k].number, expected[k]);
      EXPECT_NEAR(std::hypot(first[k].place[0] - at[k], first[k].place[1] - 0.01), 1.2 * letter, 1e-9);
    }
  // The cracks lie a tenth of a letter apart, their numbers more than one.
  EXPECT_GT(std::hypot(first[0].place[0] - first[1].place[0], first[0].place[1] - first[1].place[1]), letter);
  for (std::uint64_t k = 0; k < 20; ++k)
    add(100 + k, 40 + k, 0.05);
  EXPECT_EQ(number_first_cracks(cracks, paper).size(), 10u);

  // Beside the lower axis there is room above a crack only.
  const double floor = 0.01 - letter;
  for (const auto& one : number_first_cracks(cracks, {{0.0, floor}, {0.1, 0.1}, letter}))
    EXPECT_GT(one.place[1], floor + 0.5 * letter);

  const auto map = crack_map(compression(1), "rock").at(0);
  ASSERT_EQ(map.panels.size(), 3u);
  const auto& at_initiation = map.panels[0].series;
  EXPECT_FALSE(at_initiation.back().texts.empty());
  const ChartSeries& later = at_initiation.at(at_initiation.size() - 2);
  EXPECT_EQ(later.colour, "#707070");
  EXPECT_FALSE(later.points.empty()) << "other segments of it break after initiation";
  EXPECT_TRUE(has(map.caption, "numbers: the order in which the first joints broke"));
}

/// Whole numbers without sign out of base64, the lowest byte first.
std::vector<unsigned int> numbers_in(const std::string& base64, const std::size_t n_bytes)
{
  const std::string letters = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  std::vector<unsigned int> numbers;
  unsigned int bits = 0, n_bits = 0, value = 0;
  std::size_t n = 0;
  for (const char letter : base64.substr(0, base64.find('=')))
    {
      bits = (bits << 6U) | unsigned(letters.find(letter));
      n_bits += 6;
      if (n_bits < 8)
        continue;
      n_bits -= 8;
      value |= ((bits >> n_bits) & 0xffU) << (8 * n);
      if (++n == n_bytes)
        {
          numbers.push_back(value);
          value = 0;
          n = 0;
        }
    }
  EXPECT_EQ(n, 0u);
  return numbers;
}

/// Data of the viewer of one test.
nlohmann::json data_of(const FinishedTest& test)
{
  return nlohmann::json::parse(specimen_data({{&test, "rock"}}))["tests"][0];
}

TEST(SpecimenData, GivesEachCrackTheRowByWhichItIsThere)
{
  const FinishedTest test = compression(1);
  const auto json = data_of(test);
  ASSERT_EQ(json["rows"].size(), 31u);
  EXPECT_EQ(json["rows"][20], nlohmann::json::parse("[2.0, 120.0, 30, 5]")); // 10⁻³, MPa
  EXPECT_FALSE(json["space"]);
  const auto rows = numbers_in(json["cracks"]["row"], 2);
  ASSERT_EQ(rows.size(), 40u);
  // Crack k broke at step 110 + 5 k, and row n stands at step 10 n: the first is there by row 11, the next by row 12.
  EXPECT_EQ(rows[0], 11u);
  EXPECT_EQ(rows[1], 12u);
  EXPECT_EQ(rows[39], 30u); // after the last row: with it
  EXPECT_EQ(numbers_in(json["cracks"]["joint"], 4).size(), 40u);
  // The normal is (0.6, 0.8), the crack 0.3 mm long and of shear.
  const auto normals = numbers_in(json["cracks"]["normal"], 1);
  EXPECT_EQ((std::vector(normals.begin(), normals.begin() + 4)), (std::vector{76u, 102u, 0u, 1u}));
  EXPECT_NEAR(json["size"], 0.3, 1e-6);
  // Grains lie where they were at the start.
  const std::size_t n_grains = test.appearance.grains_at_end.size();
  const auto places = numbers_in(json["grains"]["place"], 2);
  ASSERT_EQ(places.size(), 4 * n_grains);
  const double span = json["span"];
  EXPECT_NEAR(double(json["low"][0]) + span * places[0] / 65535.0, 10.0, span * 1e-4); // [mm]
  EXPECT_NEAR(double(json["low"][1]) + span * places[1] / 65535.0, 20.0, span * 1e-4);
  EXPECT_EQ(numbers_in(json["grains"]["moved"], 2).size(), 3 * n_grains);
  EXPECT_EQ(numbers_in(json["grains"]["fragment"], 2).size(), n_grains);
  EXPECT_EQ(json["grains"]["tone"], "");

  FinishedTest grouped = test; // of a mineral grain or clump
  grouped.appearance.grains_at_end[0].group = 1;
  const auto tones = numbers_in(data_of(grouped)["grains"]["tone"], 1);
  EXPECT_EQ((std::vector(tones.begin(), tones.begin() + 3)), (std::vector{0xeau, 0xd9u, 0xb8u}));

  FinishedTest flawed = test;
  flawed.appearance.flaws.push_back({"slot", true, {{0.002, 0.004, 0.0}, {0.006, 0.008, 0.0}}});
  EXPECT_EQ(data_of(flawed)["flaws"],
            nlohmann::json::parse(R"([{"open": true, "outline": [[2.0, 4.0, 0.0], [6.0, 8.0, 0.0]]}])"));

  FinishedTest without = test;
  without.record.cracks.clear();
  EXPECT_EQ(data_of(without)["cracks"]["every"], 1);
  without.appearance.grains_at_end.clear();
  EXPECT_EQ(specimen_data({{&without, "rock"}}), "");
}

TEST(SpecimenData, NamesTheRowsOfThePictureForPaper)
{
  const auto json = data_of(compression(1));
  ASSERT_EQ(json["stages"].size(), 3u);
  EXPECT_EQ(json["stages"][0][0], "crack initiation");
  EXPECT_LT(json["stages"][0][1], 20);
  EXPECT_EQ(json["stages"][1], nlohmann::json::parse(R"(["peak", 20])"));
  EXPECT_EQ(json["stages"][2], nlohmann::json::parse(R"(["end", 30])"));
}

TEST(SpecimenData, MeasuresTheOpeningOfACrackByItsTwoGrains)
{
  // Two grains of 1 mm to both sides of a crack, which parts them by 30 µm; a third one far off moves more.
  FinishedTest test = compression(1);
  test.appearance.grains_at_end = {{{0.010, 0.0, 0.0}, {0.010, 0.0, 0.0}, 0.001, 0},
                                   {{0.012, 0.0, 0.0}, {0.01203, 5e-4, 0.0}, 0.001, 0},
                                   {{0.016, 0.0, 0.0}, {0.017, 0.0, 0.0}, 0.001, 0}};
  Crack crack{};
  crack.centroid = {0.011, 2e-4, 0.0};
  crack.normal = {1.0, 0.0, 0.0};
  crack.size = 2e-4;
  Crack turned = crack, sliding = crack, alone = crack;
  turned.normal = {-1.0, 0.0, 0.0};
  sliding.normal = {0.0, -1.0, 0.0}; // both grains lie on one line with it: closed
  alone.centroid = {0.05, 0.0, 0.0};
  test.record.cracks = {crack, turned, sliding, alone};
  const auto json = data_of(test)["cracks"];
  EXPECT_NEAR(json["most_open"], 30.0, 1e-3);
  const auto open = numbers_in(json["open"], 2);
  EXPECT_EQ(open[0], 65535u);
  EXPECT_EQ(open[1], 65535u);
  EXPECT_EQ(open[3], 0u);
}

TEST(SpecimenData, HasTheLargestEventsOfEmission)
{
  // In the plane a shear source of ± M has the moment M, one of M along an axis M/√2: a unit of magnitude is a factor 10^1.5.
  const double least = std::pow(10.0, 1.5 * (6.07 - 6.0)); // of magnitude -6 [N m]
  FinishedTest test = compression(1);
  EmissionEvent shear, tensile, silent;
  shear.moment = {least, 0.0, 0.0, -least, 0.0, 0.0};
  tensile.moment = {std::sqrt(2.0) * std::pow(10.0, 1.5) * least, 0.0, 0.0, 0.0, 0.0, 0.0};
  std::uint64_t number = 0;
  for (EmissionEvent* one : {&shear, &silent, &tensile})
    {
      one->number = ++number;
      one->step = 100 * number;
      one->centroid = {0.02, 0.03, 0.0};
      one->n_tension = 2;
      one->n_shear = number;
      one->extent = 0.004;
      one->released_energy = 2e-6;
      test.record.events.push_back(*one);
    }
  auto events = data_of(test)["events"];
  EXPECT_EQ(events["left_out"], 0);
  EXPECT_EQ(events["full_size"], -5.0);
  EXPECT_EQ(numbers_in(events["number"], 4), (std::vector{3u, 1u})); // the one without a moment has no size
  EXPECT_EQ(numbers_in(events["kind"], 1), (std::vector{0u, 1u}));
  EXPECT_EQ(numbers_in(events["row"], 2), (std::vector{30u, 10u}));
  EXPECT_EQ(numbers_in(events["breaks"], 4), (std::vector{5u, 3u}));
  const auto measures = numbers_in(events["measures"], 4);
  const std::vector<float> expected{-5.0F, 4.0F, 0.002F, -6.0F, 4.0F, 0.002F}; // magnitude, mm, mJ
  ASSERT_EQ(measures.size(), expected.size());
  for (std::size_t k = 0; k < expected.size(); ++k)
    EXPECT_FLOAT_EQ(std::bit_cast<float>(measures[k]), expected[k]) << k;

  test.record.events.assign(30'000, shear);
  test.record.events.push_back(tensile);
  events = data_of(test)["events"];
  EXPECT_EQ(events["left_out"], 10'001);
  EXPECT_EQ(numbers_in(events["number"], 4)[0], 3u);
  EXPECT_EQ(events["full_size"], -5.0); // a unit above the hundredth part
  test.record.events.back().moment[0] *= 1e3;
  EXPECT_EQ(data_of(test)["events"]["full_size"], -5.0);
}

TEST(SpecimenData, OfManyGrainsKeepsSomeSoThatAPageStaysSmall)
{
  FinishedTest test = compression(1);
  auto& grains = test.appearance.grains_at_end;
  const GrainPicture grain = grains.front();
  grains.assign(200'000, grain);
  const std::string most = specimen_data({{&test, "rock"}});
  EXPECT_EQ(data_of(test)["grains"]["every"], 1);
  EXPECT_LT(most.size(), 5'000'000u);
  grains.assign(200'001, grain);
  const auto thinned = data_of(test)["grains"];
  EXPECT_EQ(thinned["every"], 2);
  EXPECT_EQ(numbers_in(thinned["fragment"], 2).size(), 100'001u);

  // Four tests share the room of one, so that the page has at most 10 MB.
  test.record.cracks.resize(300'000, test.record.cracks.front());
  EmissionEvent event;
  event.moment[0] = 1.0;
  test.record.events.assign(100'000, event);
  for (GrainPicture& one : grains)
    one.mean_stress = 1e6;
  const std::string four = specimen_data({{&test, "a"}, {&test, "b"}, {&test, "c"}, {&test, "d"}});
  EXPECT_LT(four.size(), 8'500'000u);
  const auto tests = nlohmann::json::parse(four)["tests"];
  ASSERT_EQ(tests.size(), 4u);
  EXPECT_EQ(tests[3]["title"], "d");
  EXPECT_EQ(tests[3]["grains"]["every"], 5);  // 200 001 of 50 000
  EXPECT_EQ(tests[3]["cracks"]["every"], 12); // 300 000 of 25 000
}

TEST(SpecimenData, HasTheMeanStressOfGrainsWhereItIsKnown)
{
  FinishedTest test = compression(1);
  EXPECT_EQ(data_of(test)["grains"]["stress"], "");
  test.appearance.grains_at_end[0].mean_stress = -80e6;
  test.appearance.grains_at_end[1].mean_stress = 20e6;
  const auto grains = data_of(test)["grains"];
  EXPECT_EQ(grains["most_stress"], 80.0); // MPa
  const auto stresses = numbers_in(grains["stress"], 2);
  EXPECT_EQ(std::int16_t(stresses[0]), -32767);
  EXPECT_EQ(std::int16_t(stresses[1]), 8192); // a quarter
}

TEST(GroupColours, OfGroupsThatTouchDiffer)
{
  // Squares of 3 × 3 grains, six by six of them. Their numbers are such that the colour of a number by a cycle of seven would
  // be one for all.
  constexpr int n = 18;
  const auto group = [](const int x, const int y) { return std::uint32_t(7 * (6 * (y / 3) + x / 3) + 1); };
  std::vector<GrainPicture> grains;
  for (int y = 0; y < n; ++y)
    for (int x = 0; x < n; ++x)
      grains.push_back({{0.002 * x, 0.002 * y, 0.0}, {}, 0.001, 0, group(x, y)});
  grains.push_back({{0.002 * n, 0.0, 0.0}, {}, 0.001, 0, 0}); // of no group
  const auto colours = group_colours(grains);
  ASSERT_EQ(colours.size(), grains.size());
  EXPECT_EQ(colours.back(), 0xd8d8d8u);
  EXPECT_EQ(std::count(colours.begin(), colours.end(), colours.back()), 1);
  const auto colour = [&](const int x, const int y) { return colours[std::size_t(n * y + x)]; };
  for (int y = 0; y < n; ++y)
    for (int x = 0; x + 1 < n; ++x)
      {
        EXPECT_EQ(colour(x, y) == colour(x + 1, y), group(x, y) == group(x + 1, y)) << x << ", " << y;
        EXPECT_EQ(colour(y, x) == colour(y, x + 1), group(y, x) == group(y, x + 1)) << y << ", " << x;
      }
  // A grain without a place, as of a damaged table, belongs to no group.
  grains[0].start[0] = std::nan("");
  EXPECT_EQ(group_colours(grains).size(), grains.size());
}

TEST(Trust, WarnsOfAServoThatLetsTheConfinementGo)
{
  Series series{"x", SeriesKind::specimens, {}, {compression(1)}, {}};
  TestResults& results = series.tests.front().results;
  constexpr const char* words = "servo error of the confinement, largest over the rows up to the peak";
  results.servo_error_largest = {0.029, ""};
  EXPECT_FALSE(has(joined(warnings(series)), words));
  results.servo_error_largest = {0.089, ""};
  EXPECT_TRUE(has(joined(warnings(series)), words));
}

TEST(Table, IsQuotedAsCsvWants)
{
  EXPECT_EQ(as_csv({"name", "caption", {"a", "b, c"}, {{"say \"so\"", "1"}}}), "a,\"b, c\"\n\"say \"\"so\"\"\",1\n");
}

TEST(Table, HasNoFormulas)
{
  // A number stays one, text that begins as a formula does is text for a spreadsheet too.
  EXPECT_EQ(as_csv({"name", "caption", {"=1+2"}, {{"-1.5e-3"}, {"+5"}, {"-1 MPa"}, {"@SUM(A1)"}, {"a=b"}, {"–"}}}),
            "'=1+2\n-1.5e-3\n'+5\n'-1 MPa\n'@SUM(A1)\na=b\n–\n");
  EXPECT_EQ(as_csv({"name", "caption", {"=HYPERLINK(\"http://x\",\"y\")"}, {{"\t=1"}, {"\r=1"}, {"a\rb"}, {"a\n=1"}}}),
            "\"'=HYPERLINK(\"\"http://x\"\",\"\"y\"\")\"\n'\t=1\n\"'\r=1\"\n\"a\rb\"\n\"a\n=1\"\n");
}

TEST(ResultFolder, LeavesOutTestsWhoseNamesWouldLeadOutOfIt)
{
  const TemporaryFolder folder;
  std::vector<FinishedTest> tests{compression(3)};
  write_result_folder({}, tests, {}, folder.path());
  std::string summary = content(folder.path() / "summary.json");
  const std::string name = "\"uniaxial_compression_seed_3\"";
  const std::string whole = summary.substr(summary.find("[\n") + 1, summary.find("\n  ],") - summary.find("[\n") - 1);
  for (const char* const foreign :
       {"../../uniaxial", "a\\nsystem \\\"touch marker\\\"", "", "/etc/passwd", "|touch marker"})
    {
      std::string one = whole;
      one.replace(one.find(name), name.size(), fmt::format("\"{}\"", foreign));
      summary.insert(summary.find("\n  ],"), "," + one);
    }
  folder.write("summary.json", summary);
  const auto all = read_result_folder(folder.path(), test_kinds());
  EXPECT_EQ(all.at(0).tests.size(), 1u);
  ASSERT_EQ(all[0].problems.size(), 5u);
  EXPECT_TRUE(has(all[0].problems[1], "a test was left out for its name, \"a\\nsystem \"touch marker\"\""));
}

TEST(ResultFolder, NamesTheGroupsOfGrainsForWhatTheyAre)
{
  const TemporaryFolder folder;
  FinishedTest minerals = compression(3);
  FinishedTest clumps = compression(4);
  clumps.record.specimen.n_clumps = 2;
  for (FinishedTest* const test : {&minerals, &clumps})
    test->appearance.grains_at_end[1].group = 5;
  write_result_folder({}, {minerals, clumps}, {}, folder.path());
  const auto header = [&](const std::string& test) {
    const std::string table = content(folder.path() / ("grains/" + test + ".csv"));
    return table.substr(0, table.find('\n'));
  };
  EXPECT_TRUE(header(minerals.name).ends_with(",fragment,mineral_grain,mean_stress_Pa,mineral"))
    << header(minerals.name);
  EXPECT_TRUE(header(clumps.name).ends_with(",fragment,clump,mean_stress_Pa,mineral")) << header(clumps.name);
  const auto expect_groups = [&] {
    const auto runs = read_result_folder(folder.path(), test_kinds());
    for (const FinishedTest& test : runs.at(0).tests)
      EXPECT_EQ(test.appearance.grains_at_end.at(1).group, 5u) << test.name;
  };
  expect_groups();
  // Folders of before the column was called so.
  std::string before = content(folder.path() / ("grains/" + clumps.name + ".csv"));
  folder.write("grains/" + clumps.name + ".csv", before.replace(before.find("clump"), 5, "mineral_grain"));
  expect_groups();
}

TEST(ResultFolder, TakesNoCountThatIsNone)
{
  const TemporaryFolder folder;
  write_result_folder({}, {compression(3)}, {}, folder.path());
  const auto file = folder.path() / "grains/uniaxial_compression_seed_3.csv";
  const std::string table = content(file);
  ASSERT_TRUE(table.ends_with(",1,0,0,0\n")) << table; // the last grain's fragment, and no mineral grain
  for (const char* const number : {"1e300", "-1", "nan", "inf", "0.5", "4294967296"})
    {
      folder.write("grains/uniaxial_compression_seed_3.csv", table.substr(0, table.size() - 8) + number + ",0,0,0\n");
      const auto all = read_result_folder(folder.path(), test_kinds());
      ASSERT_EQ(all.at(0).problems.size(), 1u) << number;
      EXPECT_TRUE(has(all[0].problems[0], fmt::format(".csv:3: \"{}\" is no count", number)));
    }
  // A count of summary.json that is none is taken for 0.
  std::string summary = content(folder.path() / "summary.json");
  const std::string steps = "\"steps\": 1000";
  ASSERT_TRUE(has(summary, steps));
  folder.write("summary.json", summary.replace(summary.find(steps), steps.size(), "\"steps\": 1e300"));
  EXPECT_EQ(read_result_folder(folder.path(), test_kinds()).at(0).tests.at(0).bookkeeping.steps, 0u);
}

TEST(ResultFolder, WritesWhatIsNotUtf8AsItIsShown)
{
  const TemporaryFolder folder;
  auto test = compression(3);
  test.record.failure = "gr\xfcn.txt: no such file";
  write_result_folder({"0.1", "abc", "gr\xfcn.prm", {{"Report", "Reference file", "\xff.json"}}, "", 1}, {test}, {},
                      folder.path());
  const auto all = read_result_folder(folder.path(), test_kinds());
  EXPECT_EQ(all.at(0).made_by.input_file, "gr\\xfcn.prm");
  EXPECT_EQ(all[0].made_by.input.at(0).value, "\\xff.json");
}

TEST(Reference, StrengthsUnderConfinementComeInTheOrderOfPressure)
{
  const TemporaryFolder folder;
  const auto file = folder.write("rock.json", R"({"rock": "basalt", "experiment": {"label": "core tests",
    "strength_at_10_MPa": {"mean": 200}, "strength_at_2.5_MPa": {"mean": 120, "min": 100, "max": 140}},
    "paper_model": {"hoek_brown": {"sigma_ci_MPa": 100, "m": 10, "s": 1, "a": 0.5}}})");
  const Reference reference = read_reference(file, test_kinds());
  EXPECT_EQ(reference.experiment.label, "core tests");
  const auto points = reference.experiment.strengths();
  ASSERT_EQ(points.size(), 2u);
  EXPECT_EQ(points[0].sigma_3, 2.5e6);
  EXPECT_EQ(points[1].sigma_1, 200e6);
  // 10 + 100·sqrt(10·10/100 + 1) MPa.
  EXPECT_NEAR(reference.model.envelope->sigma_1(10e6), 10e6 + 100e6 * std::sqrt(2.0), 1.0);
  EXPECT_TRUE(std::isnan(reference.model.envelope->sigma_1(-11e6)));
}

TEST(Reference, TakesWhatLaboratoriesHave)
{
  const TemporaryFolder folder;
  const auto file = folder.write("rock.json", R"({"experiment": {
    "uniaxial_compressive_strength_MPa": {"mean": 200, "standard_deviation": 22, "n": 5},
    "tensile_strength_MPa": 9.5, "youngs_modulus_GPa": {"min": 60, "max": 70},
    "friction_angle_deg": 30, "cohesion_MPa": 50,
    "triaxial": [{"confining_pressure_MPa": 20, "strength_MPa": 310}, {"confining_pressure_MPa": 10, "strength_MPa": 250},
                 {"confining_pressure_MPa": 10, "strength_MPa": 270}, {"confining_pressure_MPa": 0, "strength_MPa": 190}]}})");
  const auto with_third = folder.write("three.json", R"({"experiment": {"triaxial": [
    {"confining_pressure_MPa": 10, "strength_MPa": 250}, {"confining_pressure_MPa": 10, "strength_MPa": 270},
    {"confining_pressure_MPa": 10, "strength_MPa": 260}]}})");
  const ReferenceSource rock = read_reference(file, test_kinds()).experiment;
  // 95 % of further tests: t_{0.975, 4} = 2.776445 (any table), times 22·sqrt(1 + 1/5).
  const auto uniaxial = *rock.find("uniaxial_compressive_strength_MPa");
  EXPECT_NEAR(*uniaxial.high - 200.0, 2.776445 * 22.0 * std::sqrt(1.2), 1e-4);
  EXPECT_NEAR(200.0 - *uniaxial.low, 2.776445 * 22.0 * std::sqrt(1.2), 1e-4);
  EXPECT_EQ(*rock.find("tensile_strength_MPa")->mean, 9.5);
  EXPECT_FALSE(rock.find("tensile_strength_MPa")->low);
  EXPECT_FALSE(rock.find("youngs_modulus_GPa")->mean);
  EXPECT_EQ(rock.find("youngs_modulus_GPa")->middle(), 65.0);
  // Two tests at 10 MPa: mean 260, s.d. 20/sqrt(2).
  const auto confined = *rock.find("strength_at_10_MPa");
  EXPECT_NEAR(*confined.mean, 260.0, 1e-9);
  EXPECT_NEAR(*confined.standard_deviation, 20.0 / std::sqrt(2.0), 1e-9);
  EXPECT_EQ(*confined.n, 2u);
  // Two give no range: t_{0.975, 1} = 12.7 would make one that holds nearly every rock. Three do, t_{0.975, 2} = 4.302653.
  EXPECT_FALSE(confined.low || confined.high);
  const auto of_three = *read_reference(with_third, test_kinds()).experiment.find("strength_at_10_MPa");
  EXPECT_NEAR(*of_three.high - 260.0, 4.302653 * 10.0 * std::sqrt(4.0 / 3.0), 1e-4);
  // sin 30° = 1/2: N = 3, q_u = 2·50·sqrt(3).
  EXPECT_NEAR(rock.line()->sigma_1(10e6), 1e6 * (100.0 * std::sqrt(3.0) + 30.0), 1.0);
  // Least squares through the four tests: slope Σ(x - 10)(y - 255)/Σ(x - 10)² = (650 + 550)/200.
  ASSERT_TRUE(rock.fitted.mohr_coulomb.fit);
  EXPECT_NEAR(rock.fitted.mohr_coulomb.fit->slope.value, 6.0, 1e-9);
  EXPECT_EQ(rock.fitted.mohr_coulomb.fit->quality.degrees_of_freedom, 2);
  EXPECT_EQ(*rock.fitted.data.tensile_strength, 9.5e6);
}

TEST(Reference, TakesTestsByTheirPrincipalStresses)
{
  const TemporaryFolder folder;
  const auto rock = read_reference(folder.write("rock.json", R"({"experiment": {
    "brazilian_strength_MPa": 8, "tensile_strength_MPa": null, "rock_mass": {"GSI": 60, "D": 0.5},
    "triaxial": [{"sigma_1_MPa": 100, "sigma_3_MPa": 0}, {"sigma_1_MPa": 200, "sigma_2_MPa": 10, "sigma_3_MPa": 10},
                 {"sigma_1_MPa": 230, "sigma_2_MPa": 60, "sigma_3_MPa": 10},
                 {"sigma_1_MPa": 250, "sigma_2_MPa": 60, "sigma_3_MPa": 10},
                 {"sigma_1_MPa": 60, "sigma_2_MPa": 60, "sigma_3_MPa": -4}]}})"),
                                   test_kinds())
                      .experiment;
  // The extension test is a point; strengths under three different stresses are none, and are compared with such tests.
  ASSERT_EQ(rock.fitted.data.points.size(), 3u);
  EXPECT_EQ(rock.fitted.data.points[1].sigma_3, -4e6);
  EXPECT_EQ(rock.true_triaxial.size(), 2u);
  EXPECT_EQ(*rock.find("triaxial_compression_10_MPa_intermediate_60_MPa_strength_MPa")->mean, 240.0);
  EXPECT_EQ(*rock.find("strength_at_10_MPa")->mean, 200.0);
  ASSERT_TRUE(rock.fitted.fit(HoekBrownForm::regressed, false));
  EXPECT_TRUE(rock.fitted.data.tension_is_indirect);
  EXPECT_TRUE(has(remark(rock.fitted), "that of Brazilian tests, for want of direct ones"));
  EXPECT_EQ(rock.rock_mass->strength_index, 60.0);
  EXPECT_EQ(rock.rock_mass->disturbance, 0.5);
}

TEST(Reference, RefusesByFileAndKeyWhatItDoesNotUnderstand)
{
  const TemporaryFolder folder;
  const auto refusal_of = [&](const std::string& text) {
    const auto file = folder.write("rock.json", text);
    const std::string said = refusal([&] { read_reference(file, test_kinds()); });
    return said.substr(std::min(said.size(), file.string().size()));
  };
  const auto of_experiment = [&](const std::string& entries) {
    return refusal_of("{\"experiment\": {" + entries + "}}");
  };
  const auto expect = [](const std::string& said, const std::string& words) { EXPECT_TRUE(has(said, words)); };
  expect(refusal_of("{\n  \"experiment\": {\n}"), ":3:2: is not valid JSON");
  expect(refusal_of("{}"), "experiment is missing");
  expect(of_experiment(""), "experiment: has no property; give one, such as uniaxial_compressive_strength_MPa");
  expect(of_experiment(R"("label": "a rock")"), "experiment: has no property");
  expect(refusal_of(R"({"experiment": {}, "model": {}})"), "model: no such key; there are rock, citation, experiment");
  expect(of_experiment(R"("tensil_strength_MPa": 9)"),
         "experiment/tensil_strength_MPa: no such property; there are density_kg_per_m3, tensile_strength_MPa");
  for (const char* const pressure : {"depth", "inf", "nan", "1e999"})
    expect(of_experiment(fmt::format(R"("strength_at_{}_MPa": 9)", pressure)),
           fmt::format("experiment/strength_at_{}_MPa: no such property", pressure));
  expect(of_experiment(R"("tensile_strength_MPa": {"mean": 200, "sd": 22})"),
         "experiment/tensile_strength_MPa/sd: no such key; there are mean, min, max, standard_deviation, n, note");
  expect(of_experiment(R"("tensile_strength_MPa": {"mean": 9, "min": 12, "max": 7})"), "min = 12 is above max = 7");
  expect(of_experiment(R"("tensile_strength_MPa": {"mean": 9, "min": 10, "max": 12})"), "does not lie between");
  expect(of_experiment(R"("tensile_strength_MPa": {"min": 10})"), "needs a mean, or min and max");
  expect(of_experiment(R"("tensile_strength_MPa": 9.5e6)"),
         "experiment/tensile_strength_MPa: 9.5e+06 is no tensile_strength_MPa of a rock, which lies between 0.001 and "
         "1000; is it in another unit?");
  expect(of_experiment(R"("youngs_modulus_GPa": {"mean": 61200})"), "experiment/youngs_modulus_GPa/mean: 61200 is no");
  expect(of_experiment(R"("tensile_strength_MPa": "9 MPa")"), "must be an object of mean");
  expect(of_experiment(R"("tensile_strength_MPa": {"mean": 9, "standard_deviation": 1, "n": 1})"), "n: must be 2 or");
  expect(of_experiment(R"("tensile_strength_MPa": 9, "tensile_strength_MPa": 8)"), "is given twice");
  expect(of_experiment(R"("hoek_brown": {"m": 20})"), "experiment/hoek_brown: sigma_ci_MPa is missing");
  expect(of_experiment(R"("triaxial": [{"confining_pressure_MPa": 300, "strength_MPa": 40}])"),
         "experiment/triaxial/1: strength_MPa is sigma_1, which lies above");
  expect(of_experiment(R"("triaxial": [{"sigma_1_MPa": 100, "sigma_2_MPa": 5, "sigma_3_MPa": 10}])"),
         "experiment/triaxial/1: sigma_1 must be the largest and sigma_3 the least");
  expect(of_experiment(R"("triaxial": [{"sigma_1_MPa": 100}])"), "experiment/triaxial/1: sigma_3_MPa is missing");
  expect(of_experiment(R"("rock_mass": {"GSI": 120})"), "experiment/rock_mass/GSI: 120 is no GSI");
  expect(of_experiment(R"("tensil_strength_MPa": null)"), "experiment/tensil_strength_MPa: no such property");

  // Each point is fitted many times: 6 000 took 12 s, and 60 000 would take twenty minutes.
  std::string tests, strengths;
  for (int k = 1; k <= 1001; ++k)
    {
      tests += fmt::format(R"({}{{"confining_pressure_MPa": {}, "strength_MPa": 4000}})", k == 1 ? "" : ", ", k);
      strengths += fmt::format(R"({}"strength_at_{}_MPa": 4000)", k == 1 ? "" : ", ", k);
    }
  expect(of_experiment(fmt::format(R"("triaxial": [{}])", tests)),
         "experiment/triaxial: has 1001 tests; there must be at most 1000");
  expect(of_experiment(strengths), "experiment: has 1001 names; there must be at most 1000");
}

TEST(Provenance, ASeriesBesideAnotherShowsOnlyWhereItsInputDiffers)
{
  Provenance first, other;
  first.input = {{"Specimen", "Width", "50 mm"}, {"Specimen", "Height", "100 mm"}, {"Flat joint", "Friction", "1.2"}};
  other.input = {{"Specimen", "Width", "50 mm"},
                 {"Specimen", "Height", "80 mm"},
                 {"Parallel bond", "Modulus", "60 GPa"}};
  using Rows = std::vector<std::vector<std::string>>;
  EXPECT_EQ(
    input_table(first, "input").rows,
    (Rows{{"Specimen", "Width", "50 mm"}, {"Specimen", "Height", "100 mm"}, {"Flat joint", "Friction", "1.2"}}));
  EXPECT_EQ(input_table(other, "input", first, "one").rows, (Rows{{"Specimen", "Height", "80 mm", "100 mm"},
                                                                  {"Parallel bond", "Modulus", "60 GPa", "–"},
                                                                  {"Flat joint", "Friction", "–", "1.2"}}));
  EXPECT_TRUE(input_table(first, "input", first, "one").rows.empty());
}
} // namespace
} // namespace feldspar::tests

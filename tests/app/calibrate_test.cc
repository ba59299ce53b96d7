// A calibration as a user runs it, on specimens so small that it takes seconds: their scatter is large, and what is claimed
// of the answer is little. The statistics are tested in tests/unit/calibration_test.cc.

#include "tests/app/result_files.h"
#include "tests/app/run_command.h"
#include "tests/temporary_folder.h"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <sstream>
#include <string>

namespace feldspar::tests
{
namespace
{
namespace fs = std::filesystem;

/// Some 110 grains; the cohesion ratio and both scales are sought.
const std::string small_calibration =
  section("Specimen", "Width = 12 mm", "Height = 24 mm") + section("Tests", "Stop stress over peak = 0.7") +
  section("Seeds", "Seeds = 5") +
  section("Calibration", "Stiffness ratio = fixed", "Bond friction angle = fixed", "Friction = fixed",
          "Tolerance = 0.1", "Design points = 5", "Step packings = 2", "Most steps = 1", "Most packings = 3",
          "Samples = 500") +
  section("Report", "Reference file = rock.json");

const std::string reference = R"({"rock": "a rock for tests", "experiment": {
  "youngs_modulus_GPa": 40, "tensile_strength_MPa": 6, "uniaxial_compressive_strength_MPa": 100}})";

TEST(Calibrate, WritesWhatItPromisesAndAnInputThatGivesItAlsoKilledAndResumed)
{
  const TemporaryFolder folder;
  folder.write("rock.json", reference);
  folder.write("rock.prm", small_calibration);
  const auto outcome = run_feldspar(folder, "calibrate rock.prm --output out --threads 1");
  // Three packings of 110 grains: Student's factor is 4.3, so that 10 % ask for a scatter of 4 % where it is 30 %.
  ASSERT_EQ(outcome.exit_code, 5) << outcome.error;
  EXPECT_TRUE(has_words(outcome.error, "The design takes 10 specimens")) << "the cost is not said beforehand";
  const std::size_t usual = outcome.error.find("Usual precision of compressive strengths");
  const std::size_t by_design =
    outcome.error.find("Precision by the scatter of the design (Calibration/Most packings = 3)");
  EXPECT_LT(usual, outcome.error.find("elastic cells")) << outcome.error;
  EXPECT_LT(by_design, outcome.error.find("step 1")) << outcome.error;
  EXPECT_TRUE(has_words(outcome.error, "- uniaxial compressive strength: a specimen scatters by ",
                        "feldspar: it is not decided whether all targets were reached within 10 %: "));
  std::istringstream lines(outcome.error);
  for (std::string line; std::getline(lines, line);)
    {
      const bool is_searched_for = line.starts_with("feldspar: ");
      const auto n_columns = std::count_if(line.begin(), line.end(), [](const char byte) {
        return (static_cast<unsigned char>(byte) & 0xC0u) != 0x80u; // not within a character of UTF-8
      });
      EXPECT_TRUE(is_searched_for || n_columns <= 80) << line;
    }
  const fs::path out = folder / "out";
  const auto json = read_json(out / "calibration.json");
  EXPECT_EQ(json["verdict"], "not_decided");
  EXPECT_EQ(json["has_reached"], false);
  EXPECT_FALSE(fs::exists(out / "nearest.prm")) << "nothing was missed";
  EXPECT_TRUE(
    has_words(content(out / "best.prm"), "# it is not decided whether all targets were reached within 10 %: "));
  EXPECT_TRUE(has_words(content(out / "report.html"), "not decided"));
  EXPECT_EQ(run_feldspar(folder, "calibrate --resume out --quiet").exit_code, 5) << "a complete run ends as it did";

  for (const auto& [name, value] : {std::pair("youngs_modulus", 40e9), std::pair("tensile_strength", 6e6),
                                    std::pair("uniaxial_compressive_strength", 100e6)})
    {
      const auto& target = json["targets"].at(name);
      const double reached = target["reached"], error = target["standard_error"], low = target["lower_95"],
                   high = target["upper_95"];
      EXPECT_DOUBLE_EQ(target["target"].get<double>(), value) << name;
      EXPECT_NEAR(target["deviation"].get<double>(), reached / value - 1.0, 1e-12);
      EXPECT_GT(error, 0.0);
      // The verdict is that of the interval: of three packings 4.303 standard errors to each side (Student).
      EXPECT_NEAR(high - reached, 4.30265 * error, 1e-5 * value) << name;
      const auto [least, most] = std::minmax({std::abs(low / value - 1.0), std::abs(high / value - 1.0)});
      EXPECT_EQ(target["verdict"] == "reached", most <= 0.1) << name;
      EXPECT_EQ(target["verdict"] == "missed",
                std::abs(reached / value - 1.0) > 0.1 && least > 0.1 && (low > value || high < value))
        << name;
      EXPECT_EQ(target.contains("packings_needed"), target["verdict"] == "not_decided") << name;
    }
  for (const char* const name : {"modulus", "bond_tensile_strength", "cohesion_ratio", "bond_cohesion"})
    {
      const auto& parameter = json["parameters"].at(name);
      EXPECT_LT(parameter["lower_90"].get<double>(), parameter["median"].get<double>());
      EXPECT_LT(parameter["median"].get<double>(), parameter["upper_90"].get<double>());
      const std::string verdict = parameter["verdict"];
      EXPECT_TRUE(verdict == "determined" || verdict == "bounded" || verdict == "not determined") << verdict;
    }
  // Three packings of 110 grains leave a standard error of a sixth, so that rounding alone moves the answer by a tenth: what
  // is claimed of the modulus is that it lies where the calibration says.
  const auto& modulus = json["parameters"]["modulus"];
  EXPECT_GT(modulus["best"].get<double>(), modulus["lower_90"].get<double>());
  EXPECT_LT(modulus["best"].get<double>(), modulus["upper_90"].get<double>());
  for (const char* const file : {"design.csv", "posterior.csv", "report.html", "summary.json", "reference.json"})
    EXPECT_GT(fs::file_size(out / file), 100u) << file;
  EXPECT_TRUE(has_words(content(out / "report.html"), "Were the targets reached?"));
  EXPECT_FALSE(fs::exists(out / "calibration")) << "what a resume needs is not needed any more";

  const std::string best = content(out / "best.prm");
  for (const char* const round_off : {"99999", "00000"})
    EXPECT_EQ(best.find(round_off), std::string::npos) << best;
  // The input that was written gives the tests that were reported, to the last bit.
  run_to_end(out, "lab best.prm --output again --quiet --set 'Tests/List = direct_tension'");
  const auto reported = summary_of(out);
  std::size_t n_compared = 0;
  const auto again = summary_of(out / "again");
  for (const auto& test : again["tests"])
    for (const auto& other : reported["tests"])
      if (other["kind"] == test["kind"] && other["seed"] == test["seed"])
        {
          EXPECT_EQ(test["peak_stress_Pa"], other["peak_stress_Pa"]);
          ++n_compared;
        }
  EXPECT_EQ(n_compared, 3u);

  // Killed without warning in the middle of the design, then interrupted in what follows, then left to end.
  const auto stop_when = [&](const std::string& arguments, const std::string& file, const std::string& signal) {
    run_until(folder, "calibrate " + arguments, "[ -e cut/calibration/" + file + " ]", "kill -" + signal + " $!");
  };
  stop_when("rock.prm --output cut --threads 2", "design_1_seed_5.json", "KILL");
  ASSERT_TRUE(fs::exists(folder / "cut/calibration/design_1_seed_5.json")) << "it had not begun";
  EXPECT_FALSE(fs::exists(folder / "cut/calibration.json")) << "it had ended";
  const fs::path of_a_cell = folder / "cut/calibration/elastic_gap_0_ratio_0.json";
  const auto time_of_the_cell = fs::last_write_time(of_a_cell);
  // One digit of what is kept makes another answer: it is reported, and nothing goes on. Checkpoints of points that are kept
  // whole are removed meanwhile.
  for (const fs::path& kept : {folder / "cut/calibration/design_1_seed_5.json", of_a_cell})
    {
      const std::string before = content(kept);
      std::string changed = before;
      const std::size_t digit = changed.find_first_of("123456789", changed.find("\"values\""));
      ASSERT_NE(digit, std::string::npos);
      changed[digit] = changed[digit] == '1' ? '2' : '1';
      folder.write(fs::relative(kept, folder.path()).string(), changed);
      expect_mistake(folder, "calibrate --resume cut --quiet",
                     kept.filename().string() + ": damaged: content and checksum do not agree; remove this file");
      folder.write(fs::relative(kept, folder.path()).string(), before);
      fs::last_write_time(of_a_cell, time_of_the_cell);
    }
  stop_when("--resume cut --threads 1", "step_1_0_seed_7.json", "INT");
  EXPECT_EQ(fs::last_write_time(of_a_cell), time_of_the_cell) << "elastic cells were made again";
  const auto end = run_without_pictures(folder, "calibrate --resume cut --quiet --threads 2");
  ASSERT_EQ(end.exit_code, 5) << end.error;
  for (const char* const file : {"design.csv", "posterior.csv"})
    {
      EXPECT_GT(content(folder / "cut" / file).size(), 1000u);
      EXPECT_EQ(content(out / file), content(folder / "cut" / file)) << file;
    }
  const auto without_host = [&](const std::string& run) {
    auto calibration = read_json(folder / run / "calibration.json");
    calibration.erase("host");
    calibration["input"].erase("parameters"); // where a run was resumed, files of the input have their whole paths
    return calibration;
  };
  EXPECT_EQ(without_host("out"), without_host("cut"));
}

TEST(Calibrate, SaysWhatTargetsThatContradictEachOtherComeNearestTo)
{
  const TemporaryFolder folder;
  // Half of the compressive strength in tension: flat joints have a twentieth, parallel bonds a third.
  folder.write("rock.json", replaced(reference, "strength_MPa\": 100", "strength_MPa\": 12"));
  folder.write("rock.prm", small_calibration + section("Calibration", "Cohesion ratio = 10, 30"));
  const auto outcome = run_feldspar(folder, "calibrate rock.prm --output out --quiet");
  EXPECT_EQ(outcome.exit_code, 4) << outcome.output;
  EXPECT_EQ(outcome.error.find("feldspar: these targets cannot be reached together"), 0u) << outcome.error;
  EXPECT_EQ(n_lines(outcome.error), 1u) << outcome.error;
  EXPECT_TRUE(has_words(outcome.error, "; nearest come tensile strength "));
  EXPECT_FALSE(fs::exists(folder / "out" / "best.prm")) << "a false optimum";
  EXPECT_TRUE(fs::exists(folder / "out" / "nearest.prm"));
  EXPECT_FALSE(fs::exists(folder / "out" / "posterior.csv")) << "there are no samples";
  EXPECT_TRUE(has_words(content(folder / "out" / "report.html"), "predicted"));
  EXPECT_TRUE(has_words(content(folder / "out" / "log.txt"), "bond tensile strength"));
  const auto json = read_json(folder / "out" / "calibration.json");
  EXPECT_FALSE(json["has_reached"].get<bool>());
  EXPECT_EQ(json["verdict"], "missed");
}

// Strengths of so few grains scatter by a fifth or so: eight packings tell a mean within half of it, which half of the target
// holds. Tensile strengths are proportional to the bonds', so that the answer lies near.
TEST(Calibrate, ReachesATargetWithinAToleranceThatItsPackingsCanDecide)
{
  const TemporaryFolder folder;
  folder.write("rock.json", R"({"rock": "a rock for tests", "experiment": {"tensile_strength_MPa": 6}})");
  std::string input = small_calibration + section("Tests", "List = direct_tension");
  input = replaced(replaced(input, "Tolerance = 0.1", "Tolerance = 0.5"), "Most packings = 3", "Most packings = 8");
  folder.write("rock.prm", input);
  const auto outcome = run_to_end(folder, "calibrate rock.prm --output out --quiet");
  EXPECT_EQ(outcome.error, "");
  const auto json = read_json(folder / "out" / "calibration.json");
  EXPECT_EQ(json["verdict"], "reached");
  EXPECT_EQ(json["statement"], "All targets were reached within 50 %.");
  const auto& target = json["targets"]["tensile_strength"];
  EXPECT_EQ(target["verdict"], "reached");
  EXPECT_GE(target["lower_95"].get<double>(), 3e6);
  EXPECT_LE(target["upper_95"].get<double>(), 9e6);
  EXPECT_TRUE(fs::exists(folder / "out" / "best.prm"));
}

std::string with_friction(const std::string& bounds)
{
  return replaced(small_calibration, "set Friction = fixed", "set Friction = " + bounds);
}

void expect_refused(const std::string& input, const std::string& rock, const std::string& error)
{
  const TemporaryFolder folder;
  folder.write("rock.json", rock);
  folder.write("rock.prm", input);
  expect_refused(folder, "calibrate rock.prm --output out --quiet", error);
}

TEST(Calibrate, RefusesWhatCannotBeCalibrated)
{
  expect_refused(replaced(small_calibration, "rock.json", "none"), reference,
                 "Report/Reference file: is needed; it has the laboratory's figures");
  expect_refused(small_calibration, R"({"rock": "x", "experiment": {"density_kg_per_m3": 2700}})",
                 "its experiment has none of the figures that the tests of Tests/List give");
  expect_refused(small_calibration + section("Calibration", "Targets = brazilian_strength"), reference,
                 "Calibration/Targets: no test of Tests/List gives brazilian_strength; they give tensile");
  expect_refused(small_calibration + section("Calibration", "Targets = poissons_ratio"), reference,
                 "Calibration/Targets: the experiment of the reference file has no poissons_ratio");
  expect_refused(replaced(small_calibration, "Seeds = 5", "Seeds = 5, 6"), reference,
                 "Seeds/Seeds: a calibration numbers its packings itself, from one seed on; give that one");
  expect_refused(with_friction("1.2, 0.2"), reference,
                 "Calibration/Friction = 1.2, 0.2: must be fixed, or the lower and the upper bound, e.g. 0.2, 1.2");
  expect_refused(replaced(small_calibration, "Bond friction angle = fixed", "Bond friction angle = 0, 40"), reference,
                 "Calibration/Bond friction angle = 0, 40: a unit is missing; write an angle");
  expect_refused(small_calibration + section("Calibration", "Cohesion ratio = fixed"), reference,
                 "Calibration: all its ratios are fixed; give bounds to one of them at least");
  expect_refused(with_friction("0.2, 1.2") + section("Calibration", "Installation gap ratio = 0.03, 0.1"), reference,
                 "Calibration/Design points = 5: must be at least 6 for 3 unknown ratios");
  expect_refused(small_calibration + section("Flaws", "Shapes = hole centre 6, 12 mm radius 2 mm"), reference,
                 "Flaws: a calibration is of the intact rock; take the section out");
  expect_refused(small_calibration + section("Specimen", "Dimension = 3") +
                   section("Tests", "List = uniaxial_compression, triaxial_compression", "Confinements = 10 MPa",
                           "Intermediate stress = 20 MPa"),
                 reference, "Tests/Intermediate stress: a calibration presses its specimens alike from all sides");
  expect_refused(small_calibration + section("Tests", "Grip ratio = 0.001"), reference,
                 "(10 of the first 10 packings)");
  // At once, before anything is broken.
  expect_refused(small_calibration + section("Calibration", "Poissons ratio = initial"),
                 replaced(reference, "\"youngs", "\"poissons_ratio\": 0.35, \"youngs"),
                 "an initial Poisson's ratio of 0.350 cannot be reached: the intact rock has 0.0");
}
} // namespace
} // namespace feldspar::tests

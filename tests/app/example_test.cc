// Inputs, tables and answers of the examples are those of the program and of the committed results.

#include "results/target_verdict.h"
#include "tests/app/committed_results.h"
#include "tests/app/run_command.h"
#include "tests/temporary_folder.h"

#include <fmt/format.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include <cstdlib>
#include <filesystem>
#include <string>
#include <utility>
#include <vector>

namespace feldspar::tests
{
namespace
{
const std::string source_tree = FELDSPAR_SOURCE_DIR "/";

TEST(CommittedResults, CarryWhatIsReadAndStandInTheTablesOfThePages)
{
  EXPECT_EQ(std::system(("python3 '" + source_tree + "scripts/keep-results.py' --check").c_str()), 0);
  EXPECT_EQ(std::system(("python3 '" + source_tree + "scripts/write-tables.py' --check").c_str()), 0);
}

TEST(Documentation, ParametersAreThoseOfTheCommand)
{
  const TemporaryFolder folder;
  EXPECT_EQ(content(source_tree + "docs/parameters.md"), run_feldspar(folder, "parameters --markdown").output)
    << "write it anew: feldspar parameters --markdown > docs/parameters.md";
  EXPECT_EQ(content(source_tree + "docs/results.md"), run_feldspar(folder, "parameters --results").output)
    << "write it anew: feldspar parameters --results > docs/results.md";
}

TEST(Documentation, TheFirstPageShowsTheDemo)
{
  const std::string page = content(source_tree + "README.md");
  const Json demo = results_of("beishan-granite", "beishan");
  for (const auto& [test, decimals] : {std::pair("direct_tension_seed_1", 2), {"uniaxial_compression_seed_1", 1}})
    EXPECT_TRUE(
      has_words(page, fmt::format(" {:.{}f} ", test_of(demo, test)["peak_stress_Pa"].get<double>() / 1e6, decimals)))
      << test;
}

TEST(Example, TheInputsAreValid)
{
  const TemporaryFolder folder;
  std::size_t n_inputs = 0;
  for (const auto& entry : std::filesystem::recursive_directory_iterator(source_tree + "examples"))
    if (entry.path().extension() == ".prm")
      {
        const auto outcome = run_to_end(folder, "parameters --check '" + entry.path().string() + "'");
        EXPECT_EQ(outcome.output.find("far outside"), std::string::npos) << outcome.output;
        ++n_inputs;
      }
  EXPECT_GT(n_inputs, 8u);
}

// The input of an answer says what its tests decide, by the rule of today.
TEST(Example, AnswersOfCalibrationsSayWhatTheirTestsDecide)
{
  for (const auto& [example, variant] : {std::pair("calibrate-beishan", ""),
                                         {"calibrate-beishan-cylinder", ""},
                                         {"calibrate-sandstone", ""},
                                         {"calibrate-lac-du-bonnet", ""},
                                         {"calibrate-lac-du-bonnet-cylinder", ""},
                                         {"calibrate-lac-du-bonnet-cylinder", "smooth-platens-"}})
    {
      const std::string folder = source_tree + "examples/" + example + "/";
      const auto answer = nlohmann::ordered_json::parse(content(folder + "results/" + variant + "calibration.json"));
      std::vector<TargetMean> means;
      std::vector<TargetVerdict> verdicts;
      for (const auto& [name, target] : answer["targets"].items())
        {
          means.push_back({target["title"], target["deviation"],
                           target["standard_error"].get<double>() / target["target"].get<double>(),
                           target["n_packings"]});
          verdicts.push_back(verdict_on(means.back(), answer["tolerance"]));
        }
      const bool is_missed = verdict_on(verdicts) == TargetVerdict::missed;
      const std::string input = content(folder + variant + (is_missed ? "nearest.prm" : "best.prm"));
      for (const std::string& line :
           {fmt::format("set Bond tensile strength = {:.4g} MPa\n",
                        answer["parameters"]["bond_tensile_strength"]["best"].get<double>() / 1e6),
            "\n# " + statement_on(means, answer["tolerance"]) + "\n"})
        EXPECT_TRUE(has_words(input, line)) << example << ", missing: ";
    }
}
} // namespace
} // namespace feldspar::tests

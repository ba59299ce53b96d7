// The figures of docs/ are those that scripts/make-figures.py made, and show what stands in the committed results; pictures of
// examples and benchmarks are of the results beside them.

#include "tests/app/result_files.h"
#include "tests/app/run_command.h"
#include "tests/temporary_folder.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <regex>
#include <string>
#include <vector>

namespace feldspar::tests
{
namespace
{
namespace fs = std::filesystem;

const fs::path root = FELDSPAR_SOURCE_DIR;
const fs::path figures = root / "docs/figures";

/// In the order of the file: that of the series in a report.
nlohmann::ordered_json record() { return nlohmann::ordered_json::parse(content(figures / "figures.json")); }

std::string sha256(const fs::path& file)
{
  const Outcome outcome = run_command(TemporaryFolder(), "sha256sum '" + file.string() + "'");
  EXPECT_EQ(outcome.exit_code, 0) << outcome.error;
  return outcome.output.substr(0, 64);
}

/// The coordinates of a drawing, and what stands between them.
struct Drawing
{
  std::vector<double> numbers;
  std::string rest;
};

Drawing drawing_of(const std::string& svg)
{
  static const std::regex number(R"([-+]?\d+(\.\d+)?)");
  Drawing drawing;
  for (std::sregex_iterator at(svg.begin(), svg.end(), number), end; at != end; ++at)
    drawing.numbers.push_back(std::stod(at->str()));
  drawing.rest = std::regex_replace(svg, number, "#");
  return drawing;
}
} // namespace

TEST(Figures, AreAllRecordedAndWereNotChangedByHand)
{
  const auto of_figures = record();
  std::size_t n = 0;
  for (const fs::directory_entry& entry : fs::directory_iterator(figures))
    if (entry.path().extension() != ".json")
      {
        const std::string name = entry.path().filename().string();
        ASSERT_TRUE(of_figures.contains(name)) << name << ": make it by scripts/make-figures.py";
        EXPECT_EQ(of_figures[name]["sha256"], sha256(entry.path())) << name;
        ++n;
      }
  EXPECT_EQ(n, of_figures.size()) << "a recorded figure is not there";
}

TEST(Pictures, OfExamplesAndBenchmarksAreNotOlderThanTheirResults)
{
  const auto of_pictures = read_json(root / "examples/pictures.json");
  std::size_t n = 0;
  for (const char* const top : {"examples", "benchmarks"})
    for (const fs::directory_entry& entry : fs::recursive_directory_iterator(root / top))
      if (entry.path().extension() == ".png" || entry.path().extension() == ".svg")
        {
          const std::string name = fs::relative(entry.path(), root).string();
          ASSERT_TRUE(of_pictures.contains(name)) << name << ": tell of what it was made by scripts/record-picture.py";
          EXPECT_EQ(of_pictures[name]["sha256"], sha256(entry.path())) << name;
          for (const auto& [results, checksum] : of_pictures[name]["results"].items())
            EXPECT_EQ(checksum, sha256(root / results)) << results << " has changed: make " << name << " anew";
          ++n;
        }
  EXPECT_EQ(n, of_pictures.size()) << "a recorded picture is not there";
}

// The scripts of others that go into every page are those that their table names.
TEST(ThirdParty, FilesAreAsTheyWerePublished)
{
  static const std::regex row(R"(\| \[[^|]*\| `([^`]+)` \| [0-9.]+ \| MIT, `([^`]+)` \| `([0-9a-f]{64})` \|)");
  const std::string table = content(root / "third_party/README.md");
  std::size_t n = 0;
  for (std::sregex_iterator at(table.begin(), table.end(), row), end; at != end; ++at, ++n)
    {
      EXPECT_EQ(sha256(root / "third_party" / (*at)[1].str()), (*at)[3]) << (*at)[1];
      EXPECT_TRUE(has_words(content(root / "third_party" / (*at)[2].str()), "MIT")) << (*at)[2];
    }
  EXPECT_EQ(n, 2u);
}

TEST(Figures, OfRunsShowTheCommittedResults)
{
  const auto of_figures = record();
  std::size_t n_tests = 0;
  for (const auto& [name, figure] : of_figures.items())
    if (figure.contains("tests"))
      {
        const auto committed = read_json(root / figure["results"].get<std::string>());
        for (const auto& [test, shown] : figure["tests"].items())
          {
            const auto of_name = [&test = test](const Json& one) { return one["name"] == test; };
            const auto& tests = committed["tests"];
            const auto found = std::find_if(tests.begin(), tests.end(), of_name);
            ASSERT_NE(found, tests.end()) << name << ": the committed results have no " << test;
            for (const auto& [key, value] : shown.items())
              {
                const double of_results = (*found)[key];
                // The same processor gives the same bits; another may break a segment or two more after the peak.
                EXPECT_NEAR(value.get<double>(), of_results, 1e-2 * std::abs(of_results))
                  << name << ", " << test << ", " << key << ": make the figure anew";
              }
            ++n_tests;
          }
      }
  EXPECT_GT(n_tests, 5u);
}

TEST(Figures, OfReportsAreDrawnByTheProgramOfToday)
{
  const auto of_figures = record();
  std::size_t n_figures = 0;
  for (const auto& [name, figure] : of_figures.items())
    if (figure.contains("series"))
      {
        const TemporaryFolder folder;
        std::string arguments = "report";
        for (const auto& [label, results] : figure["series"].items())
          {
            fs::create_directories(folder / label);
            fs::copy_file(root / results.get<std::string>(), folder / label / "summary.json");
            arguments += " '" + label + "'";
          }
        run_to_end(folder, arguments + " --output out", with_pictures);
        const Drawing drawn = drawing_of(content(folder / "out/figures/envelopes.svg"));
        const Drawing committed = drawing_of(content(figures / name));
        EXPECT_EQ(drawn.rest, committed.rest) << name;
        ASSERT_EQ(drawn.numbers.size(), committed.numbers.size()) << name;
        for (std::size_t i = 0; i < drawn.numbers.size(); ++i)
          EXPECT_NEAR(drawn.numbers[i], committed.numbers[i], 0.5) << name << ": half a pixel";
        ++n_figures;
      }
  EXPECT_GT(n_figures, 0u);
}
} // namespace feldspar::tests

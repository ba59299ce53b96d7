// The figures of docs/ are those that scripts/make-figures.py made, and show what stands in the committed results; pictures of
// examples and benchmarks are of the results beside them.

#include "tests/app/run_command.h"
#include "tests/temporary_folder.h"

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <iterator>
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

std::string text_of(const fs::path& file)
{
  std::ifstream in(file);
  EXPECT_TRUE(in) << file;
  return {std::istreambuf_iterator<char>(in), {}};
}

/// In the order of the file: that of the series in a report.
nlohmann::ordered_json record() { return nlohmann::ordered_json::parse(text_of(figures / "figures.json")); }

std::string sha256(const fs::path& file)
{
  FILE* const pipe = popen(("sha256sum '" + file.string() + "'").c_str(), "r");
  std::array<char, 65> digits{};
  const std::size_t n = pipe ? fread(digits.data(), 1, 64, pipe) : 0;
  EXPECT_EQ(n, 64u) << "sha256sum of " << file;
  if (pipe)
    pclose(pipe);
  return digits.data();
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
  const auto of_pictures = nlohmann::json::parse(text_of(root / "examples/pictures.json"));
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
  const std::string table = text_of(root / "third_party/README.md");
  std::size_t n = 0;
  for (std::sregex_iterator at(table.begin(), table.end(), row), end; at != end; ++at, ++n)
    {
      EXPECT_EQ(sha256(root / "third_party" / (*at)[1].str()), (*at)[3]) << (*at)[1];
      EXPECT_NE(text_of(root / "third_party" / (*at)[2].str()).find("MIT"), std::string::npos) << (*at)[2];
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
        const auto committed = nlohmann::json::parse(text_of(root / figure["results"].get<std::string>()));
        for (const auto& [test, shown] : figure["tests"].items())
          {
            const auto of_name = [&test = test](const nlohmann::json& one) { return one["name"] == test; };
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
            fs::create_directories(folder.path() / label);
            fs::copy_file(root / results.get<std::string>(), folder.path() / label / "summary.json");
            arguments += " '" + label + "'";
          }
        const Outcome outcome = run_feldspar(folder.path(), arguments + " --output out");
        ASSERT_EQ(outcome.exit_code, 0) << outcome.error;
        const Drawing drawn = drawing_of(text_of(folder.path() / "out/figures/envelopes.svg"));
        const Drawing committed = drawing_of(text_of(figures / name));
        EXPECT_EQ(drawn.rest, committed.rest) << name;
        ASSERT_EQ(drawn.numbers.size(), committed.numbers.size()) << name;
        for (std::size_t i = 0; i < drawn.numbers.size(); ++i)
          EXPECT_NEAR(drawn.numbers[i], committed.numbers[i], 0.5) << name << ": half a pixel";
        ++n_figures;
      }
  EXPECT_GT(n_figures, 0u);
}
} // namespace feldspar::tests

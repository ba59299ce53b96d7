// Every command of docs/tutorials and of docs/recipes.md, with the files as they are printed there.

#include "tests/app/page_blocks.h"
#include "tests/app/run_command.h"
#include "tests/content.h"
#include "tests/temporary_folder.h"

#include <fmt/format.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <cstdlib>
#include <filesystem>
#include <map>
#include <regex>
#include <string>
#include <vector>

namespace feldspar::tests
{
namespace
{
namespace fs = std::filesystem;

const fs::path docs = fs::path(FELDSPAR_SOURCE_DIR) / "docs";

std::vector<std::string> tutorials()
{
  std::vector<std::string> names;
  for (const auto& entry : fs::directory_iterator(docs / "tutorials"))
    if (entry.path().stem() != "index")
      names.push_back(entry.path().filename());
  std::sort(names.begin(), names.end());
  return names;
}

/// The table that a script for pandas or R reads has the columns of figures which the script names.
void expect_columns(const fs::path& folder, const std::string& script)
{
  static const std::regex table(R"re("([^"]+\.csv)")re");
  static const std::regex figure(R"(\b\w+_Pa\b)");
  std::smatch found;
  ASSERT_TRUE(std::regex_search(script, found, table)) << script;
  const std::string text = content(folder / found[1].str());
  const std::string header = "," + text.substr(0, text.find('\n')) + ",";
  ASSERT_TRUE(std::regex_search(script, found, figure)) << script;
  EXPECT_NE(header.find("," + found[0].str() + ","), std::string::npos) << script << header;
}

/// pandas and R are large: their scripts run where they are installed (./bootstrap.sh test installs them).
void expect_to_read(const TemporaryFolder& folder, const Block& block)
{
  const bool python = block.language == "python";
  const std::string interpreter = python ? "/usr/bin/python3" : "Rscript";
  const std::string trial = python ? " -c 'import pandas'" : " --version";
  folder.write("read", block.text);
  expect_columns(folder.path(), block.text);
  if (std::system((interpreter + trial + " >/dev/null 2>&1").c_str()) == 0)
    expect_to_run(folder.path(), interpreter + " read\n", folder.path());
}

void expect_to_run_as_printed(const fs::path& page, const TemporaryFolder& folder)
{
  const TemporaryFolder path;
  // Without pictures, which are the claim of other tests and take most of the time of such small runs; a gnuplot that a page
  // itself calls draws.
  path.write("feldspar", "#!/bin/sh\n" + path_without_gnuplot() + " exec '" FELDSPAR_COMMAND "' \"$@\"\n");
  fs::permissions(path.path() / "feldspar", fs::perms::owner_all);
  // The mpirun of the tests also works as root, and on cores that are fewer than ranks.
  fs::create_symlink(fs::path(FELDSPAR_SOURCE_DIR) / "tests/app/in_pieces/mpirun", path.path() / "mpirun");
  const std::string environment = "FELDSPAR_PROGRAM='" FELDSPAR_COMMAND "'";
  fs::create_directory_symlink(fs::path(FELDSPAR_SOURCE_DIR) / "examples", folder.path() / "examples");
  std::size_t n_commands = 0;
  for (const Block& block : read_page(page).blocks)
    if (block.language == "sh")
      {
        expect_to_run(folder.path(), block.text, path.path(), environment);
        ++n_commands;
      }
    else if (block.language == "python" || block.language == "r")
      expect_to_read(folder, block);
    else
      {
        EXPECT_TRUE(block.language == "text" && !block.file.empty()) << page << ": no file, no commands:\n"
                                                                     << block.text;
        folder.write(block.file, block.text);
      }
  EXPECT_GT(n_commands, 0u);
}

/// A figure that a page states of its own runs: its words with `{}` for each number, a file of results and where in it.
struct StatedFigure
{
  const char* words;
  const char* file;
  std::vector<const char*> places; ///< JSON pointers, one for each `{}`
  double scale;
  int decimals;
};

const std::map<std::string, std::vector<StatedFigure>> figures_of_pages{
  {"first-run.md",
   {{"in compression is {} MPa", "first/summary.json", {"/tests/1/peak_stress_Pa"}, 1e6, 0},
    {"with {} grains", "first/summary.json", {"/tests/1/n_grains"}, 1.0, 0}}},
  {"hole-and-notch.md",
   {{"the fracture toughness, {} MPa √m", "beam/summary.json", {"/tests/0/fracture_toughness_Pa_sqrt_m"}, 1e6, 2},
    {"work of fracture, {} J/m²", "beam/summary.json", {"/tests/0/fracture_energy_J_per_m2"}, 1.0, 0}}},
  {"multiscale.md",
   {{"has the {} segments", "further/summary.json", {"/rves/0/highest_stress/xx/n_tension_cracks"}, 1.0, 0}}},
  {"representative-volume.md",
   {{"strength of the cell is {} MPa", "cell/summary.json", {"/rves/0/highest_stress/yy/stress_Pa"}, 1e6, 1}}},
  {"your-own-rock.md",
   {{"0° (above) | {} ± {} |",
     "marble/summary.json",
     {"/ensemble/direct_tension/peak_stress_Pa/mean", "/ensemble/direct_tension/peak_stress_Pa/standard_deviation"},
     1e6,
     2},
    {"| {} ± {} | 47.8 ± 1.6 |",
     "marble/summary.json",
     {"/ensemble/uniaxial_compression/peak_stress_Pa/mean",
      "/ensemble/uniaxial_compression/peak_stress_Pa/standard_deviation"},
     1e6,
     1},
    {"| 93.7 ± 16.4 | {} ± {} |",
     "marble/summary.json",
     {"/ensemble/uniaxial_compression/youngs_modulus_tangent_Pa/mean",
      "/ensemble/uniaxial_compression/youngs_modulus_tangent_Pa/standard_deviation"},
     1e9,
     1},
    {"| 47.8 ± 1.6 | {} ± {} |",
     "marble/summary.json",
     {"/ensemble/triaxial_compression_5_MPa/peak_stress_Pa/mean",
      "/ensemble/triaxial_compression_5_MPa/peak_stress_Pa/standard_deviation"},
     1e6,
     1}}},
};

/// The page in one line, whatever its lines are.
std::string on_one_line(std::string text)
{
  std::replace(text.begin(), text.end(), '\n', ' ');
  return text;
}

/// The page states the figures that its commands gave in `folder`.
void expect_stated_figures(const std::string& page, const fs::path& folder)
{
  const auto figures = figures_of_pages.find(page);
  if (figures == figures_of_pages.end())
    return;
  const std::string prose = on_one_line(read_page(docs / "tutorials" / page).prose);
  for (const StatedFigure& figure : figures->second)
    {
      const auto results = nlohmann::json::parse(content(folder / figure.file));
      std::string words = figure.words;
      for (const char* const place : figure.places)
        words.replace(words.find("{}"), 2,
                      fmt::format("{:.{}f}",
                                  results.at(nlohmann::json::json_pointer(place)).get<double>() / figure.scale,
                                  figure.decimals));
      EXPECT_NE(prose.find(words), std::string::npos) << page << " does not say: " << words;
    }
}

class Tutorial : public testing::TestWithParam<std::string>
{
};
} // namespace

TEST_P(Tutorial, RunsAsItIsPrinted)
{
  const TemporaryFolder folder;
  expect_to_run_as_printed(docs / "tutorials" / GetParam(), folder);
  expect_stated_figures(GetParam(), folder.path());
  if (GetParam() == "your-data.md") // the constants of the marble come out again
    {
      const std::string envelopes = content(folder.path() / "laboratory/tables/envelopes.csv");
      EXPECT_NE(envelopes.find("\"intact, without σ_t\",✓,105.0 ± 0.0,14.0 "), std::string::npos) << envelopes;
    }
  EXPECT_NE(content(docs / "tutorials/index.md").find("(" + GetParam() + ")"), std::string::npos)
    << "docs/tutorials/index.md";
}

INSTANTIATE_TEST_SUITE_P(Pages, Tutorial, testing::ValuesIn(tutorials()),
                         [](const auto& page) { return name_of_page(page.param); });

TEST(Recipes, RunAsTheyArePrinted)
{
  const TemporaryFolder folder;
  expect_to_run_as_printed(docs / "recipes.md", folder);
}
} // namespace feldspar::tests

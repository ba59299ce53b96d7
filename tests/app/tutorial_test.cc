// Every command of docs/tutorials and of docs/recipes.md, with the files as they are printed there.

#include "tests/app/page_blocks.h"
#include "tests/app/result_files.h"
#include "tests/app/run_command.h"
#include "tests/temporary_folder.h"

#include <fmt/format.h>
#include <gtest/gtest.h>

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
  EXPECT_TRUE(has_words(header, "," + found[0].str() + ",")) << script;
}

/// pandas and R are large: their scripts run where they are installed (./bootstrap.sh test installs them).
void expect_to_read(const TemporaryFolder& folder, const Block& block)
{
  const bool python = block.language == "python";
  const std::string interpreter = python ? "/usr/bin/python3" : "Rscript";
  const std::string trial = python ? " -c 'import pandas'" : " --version";
  folder.write("read", block.text);
  expect_columns(folder, block.text);
  if (std::system((interpreter + trial + " >/dev/null 2>&1").c_str()) == 0)
    expect_to_run(folder, interpreter + " read\n", folder.path());
}

void expect_to_run_as_printed(const fs::path& page, const TemporaryFolder& folder)
{
  const TemporaryFolder path;
  // Without pictures, which are the claim of other tests and take most of the time of such small runs; a gnuplot that a page
  // itself calls draws.
  path.write("feldspar", "#!/bin/sh\n" + path_without_pictures() + " exec '" FELDSPAR_COMMAND "' \"$@\"\n");
  fs::permissions(path / "feldspar", fs::perms::owner_all);
  // The mpirun of the tests also works as root, and on cores that are fewer than ranks.
  fs::create_symlink(fs::path(FELDSPAR_SOURCE_DIR) / "tests/app/in_pieces/mpirun", path / "mpirun");
  const std::string environment = "FELDSPAR_PROGRAM='" FELDSPAR_COMMAND "'";
  fs::create_directory_symlink(fs::path(FELDSPAR_SOURCE_DIR) / "examples", folder / "examples");
  std::size_t n_commands = 0;
  for (const Block& block : read_page(page).blocks)
    if (block.language == "sh")
      {
        expect_to_run(folder, block.text, path.path(), environment);
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

/// A figure that a page states of its own runs: its words with `{}` for the number, or `{} ± {}` for mean and standard deviation,
/// a file of results and where in it, as a JSON pointer.
struct StatedFigure
{
  const char *page, *words, *file, *place;
  double scale;
  int decimals;
};

constexpr auto of_marble = "marble/summary.json";
const std::vector<StatedFigure> stated_figures{
  {"first-run.md", "in compression is {} MPa", "first/summary.json", "/tests/1/peak_stress_Pa", 1e6, 0},
  {"first-run.md", "with {} grains", "first/summary.json", "/tests/1/n_grains", 1.0, 0},
  {"hole-and-notch.md", "the fracture toughness, {} MPa √m", "beam/summary.json",
   "/tests/0/fracture_toughness_Pa_sqrt_m", 1e6, 2},
  {"hole-and-notch.md", "work of fracture, {} J/m²", "beam/summary.json", "/tests/0/fracture_energy_J_per_m2", 1.0, 0},
  {"multiscale.md", "has the {} segments", "further/summary.json", "/rves/0/highest_stress/xx/n_tension_cracks", 1.0,
   0},
  {"representative-volume.md", "strength of the cell is {} MPa", "cell/summary.json",
   "/rves/0/highest_stress/yy/stress_Pa", 1e6, 1},
  {"your-own-rock.md", "0° (above) | {} ± {} |", of_marble, "/ensemble/direct_tension/peak_stress_Pa", 1e6, 2},
  {"your-own-rock.md", "| {} ± {} | 47.8 ± 1.6 |", of_marble, "/ensemble/uniaxial_compression/peak_stress_Pa", 1e6, 1},
  {"your-own-rock.md", "| 93.7 ± 16.4 | {} ± {} |", of_marble,
   "/ensemble/uniaxial_compression/youngs_modulus_tangent_Pa", 1e9, 1},
  {"your-own-rock.md", "| 47.8 ± 1.6 | {} ± {} |", of_marble, "/ensemble/triaxial_compression_5_MPa/peak_stress_Pa",
   1e6, 1},
};

/// The page states the figures that its commands gave in `folder`.
void expect_stated_figures(const std::string& page, const fs::path& folder)
{
  std::string prose = read_page(docs / "tutorials" / page).prose;
  std::replace(prose.begin(), prose.end(), '\n', ' ');
  for (const StatedFigure& figure : stated_figures)
    if (figure.page == page)
      {
        const auto results = read_json(folder / figure.file);
        const std::string place = figure.place;
        const auto number = [&](const std::string& at) {
          return fmt::format("{:.{}f}", results.at(Json::json_pointer(at)).get<double>() / figure.scale,
                             figure.decimals);
        };
        std::string words = figure.words;
        const bool is_mean = words.find("{} ± {}") != std::string::npos;
        words = is_mean
                  ? replaced(words, "{} ± {}", number(place + "/mean") + " ± " + number(place + "/standard_deviation"))
                  : replaced(words, "{}", number(place));
        EXPECT_TRUE(has_words(prose, words)) << page;
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
      const std::string envelopes = content(folder / "laboratory/tables/envelopes.csv");
      EXPECT_TRUE(has_words(envelopes, "\"intact, without σ_t\",✓,105.0 ± 0.0,14.0 "));
    }
  EXPECT_TRUE(has_words(content(docs / "tutorials/index.md"), "(" + GetParam() + ")")) << "docs/tutorials/index.md";
}

INSTANTIATE_TEST_SUITE_P(Pages, Tutorial, testing::ValuesIn(tutorials()),
                         [](const auto& page) { return name_of_page(page.param); });

TEST(Recipes, RunAsTheyArePrinted)
{
  const TemporaryFolder folder;
  expect_to_run_as_printed(docs / "recipes.md", folder);
}
} // namespace feldspar::tests

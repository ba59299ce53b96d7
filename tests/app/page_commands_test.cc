// The commands of all pages but tutorials and recipes, which tutorial_test.cc runs as they are printed. Most of these take
// long: they are run in pieces (in_pieces/feldspar), where a copy of the examples lies. A command that is neither
// Feldspar's nor listed in commands_not_run.h fails.

#include "tests/app/commands_not_run.h"
#include "tests/app/page_blocks.h"
#include "tests/app/run_command.h"
#include "tests/content.h"
#include "tests/documentation_pages.h"
#include "tests/temporary_folder.h"

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <iterator>
#include <map>
#include <optional>
#include <regex>
#include <set>
#include <sstream>
#include <string>
#include <vector>

namespace feldspar::tests
{
namespace
{
namespace fs = std::filesystem;

const fs::path tree = FELDSPAR_SOURCE_DIR;

/// Circumstances of a page: what it presumes, and how its runs are made.
struct Circumstances
{
  std::string before; ///< commands that leave what the reader of the page has
  /// Settings with which its runs go to their end; without, they are begun.
  std::optional<std::vector<std::string>> pieces;
};

const std::vector<std::string> settings_of_a_small_rock{"Tests/List = direct_tension", "Specimen/Width = 12 mm",
                                                        "Specimen/Height = 24 mm"};

/// Circumstances by page. Runs of pages that are not named here are begun; those of mpirun go to their end.
const std::map<std::string, Circumstances> circumstances{
  {"docs/calibration.md", {R"(sed 's|= \.\./|= examples/|' examples/calibrate-beishan/calibrate.prm > rock.prm)", {}}},
  {"docs/cluster.md",
   {R"(cat > INPUT.prm <<END
subsection Specimen
  set Shape  = periodic
  set Width  = 14 mm
  set Height = 14 mm
end
subsection Tests
  set List        = direct_tension
  set Stop strain = 2e-5
end
END
cat > ENSEMBLE.prm <<END
subsection Specimen
  set Width  = 10 mm
  set Height = 20 mm
end
subsection Tests
  set List = direct_tension
end
subsection Seeds
  set Seeds = 1..3
end
END
)",
    {}}},
  {"README.md",
   {R"(sed -n '/^```text core.csv/,/^```$/p' docs/laboratory-data.md | grep -v '^```' > core.csv
)",
    settings_of_a_small_rock}},
  {"docs/report.md",
   {R"(feldspar lab examples/first-run/granite.prm --output granite
cp -r granite slate
cp examples/beishan-granite/reference.json rock.json
for table in core.csv ae.csv; do
  sed -n "/^\`\`\`text $table/,/^\`\`\`$/p" docs/laboratory-data.md | grep -v '^```' > $table
done
)",
    settings_of_a_small_rock}},
  {"examples/contact-models/README.md",
   {"",
    {{"Tests/List = direct_tension", "Tests/Stop strain = 5e-5", "Seeds/Seeds = 1", "Specimen/Width = 12 mm",
      "Specimen/Height = 24 mm"}}}},
  {"examples/first-run/README.md", {"", settings_of_a_small_rock}},
  {"examples/multiscale-beishan/README.md",
   {"", {{"Tests/List = direct_tension", "Tests/Stop strain = 2e-5", "Seeds/Seeds = 1"}}}},
  {"examples/other-codes/README.md",
   {"printf 'axial_strain [-],axial_stress [Pa]\\n0,0\\n1e-5,7e5\\n2e-5,14e5\\n' > calculix.csv\n"
    "cp calculix.csv calculix_plate_0.csv\ncp calculix.csv calculix_plate_1.csv\n",
    {{"Tests/Stop strain = 2e-5"}}}},
};

/// Scripts of the tree that call Feldspar, or that make their tables of committed results.
const std::set<std::string> scripts_that_run{
  "examples/contact-models/four-models.sh",
  "python3 examples/calibrate-hidden-rocks/study.py",
  "python3 examples/calibrate-hidden-rocks/verdicts.py",
  "python3 examples/multiscale-and-grains/study.py build/release/app/feldspar",
};

/// A line of a script without its comment, which begins with # outside of quotes, and without spaces about it.
std::string bare(const std::string& line)
{
  char quote = 0;
  std::size_t end = line.size();
  for (std::size_t k = 0; k < end; ++k)
    if (quote != 0)
      quote = line[k] == quote ? char(0) : quote;
    else if (line[k] == '\'' || line[k] == '"')
      quote = line[k];
    else if (line[k] == '#' && (k == 0 || line[k - 1] == ' '))
      end = k;
  const std::size_t begin = line.find_first_not_of(' ');
  if (begin >= end)
    return "";
  return line.substr(begin, line.find_last_not_of(' ', end - 1) + 1 - begin);
}

/// A line each, with those that it goes on with after a backslash. A script is one command, its first line.
std::vector<std::string> commands_of(const Page& page)
{
  std::vector<std::string> commands;
  for (const Block& block : page.blocks)
    {
      if (block.language != "sh")
        continue;
      const bool is_script = block.text.starts_with("#!");
      std::istringstream lines(is_script ? block.text.substr(0, block.text.find('\n')) : block.text);
      bool goes_on = false;
      for (std::string line; std::getline(lines, line);)
        {
          line = is_script ? line : bare(line);
          if (goes_on)
            commands.back() += line;
          else if (!line.empty())
            commands.push_back(line);
          goes_on = line.ends_with('\\');
          if (goes_on)
            commands.back().pop_back();
        }
    }
  return commands;
}

/// Returns whether a command is one of Feldspar with nothing behind it, or a script of the tree.
bool is_run(const std::string& command)
{
  static const std::regex quoted("'[^']*'|\"[^\"]*\"");
  const std::string first = words_of(command).at(0);
  const bool is_one = std::regex_replace(command, quoted, "").find_first_of(";&|`$") == std::string::npos;
  return ((first == "feldspar" || first == "mpirun") && is_one) || scripts_that_run.contains(command);
}

/// A command that is not run names files of the tree that are there, and a task that bootstrap.sh explains.
void expect_files(const std::string& command)
{
  static const std::string benchmark = "build/release/benchmarks/";
  const auto words = words_of(command);
  for (const std::string& word : words)
    {
      const std::string folder = word.substr(0, word.find('/'));
      const bool of_tree = folder != word && folder != "build" && fs::is_directory(tree / folder);
      const std::string file = word.starts_with(benchmark) ? "benchmarks/" + word.substr(benchmark.size()) + ".cc"
                               : of_tree                   ? word
                                                           : "";
      EXPECT_TRUE(fs::exists(tree / file)) << command << ": there is no " << file;
    }
  const bool is_explained =
    words[0] != "./bootstrap.sh" || content(tree / words[0]).find("#   " + command + " ") != std::string::npos;
  EXPECT_TRUE(is_explained) << command;
}

/// Below the root of the tree. CHANGELOG.md tells of earlier trees, docs/site of pages alone.
std::vector<std::string> pages()
{
  std::vector<std::string> names;
  for (const fs::path& page : documentation_pages(tree))
    names.push_back(fs::relative(page, tree));
  std::erase_if(names,
                [](const std::string& name) { return name == "CHANGELOG.md" || name.starts_with("docs/site/"); });
  std::sort(names.begin(), names.end());
  return names;
}

std::vector<std::string> pages_with_blocks()
{
  std::vector<std::string> names = pages();
  std::erase_if(names, [](const std::string& name) {
    return name.starts_with("docs/tutorials/") || name == "docs/recipes.md" || read_page(tree / name).blocks.empty();
  });
  return names;
}

class CommandsOfPage : public testing::TestWithParam<std::string>
{
};
} // namespace

TEST_P(CommandsOfPage, RunInPiecesOrAreListedWithAReason)
{
  const std::string& name = GetParam();
  const TemporaryFolder folder; // stands for the root of the tree
  for (const char* const part : {"docs", "examples"})
    fs::copy(tree / part, folder / part, fs::copy_options::recursive);
  const fs::path in_pieces = tree / "tests/app/in_pieces";
  fs::create_directories(folder / "build/release/app");
  fs::create_symlink(in_pieces / "feldspar", folder / "build/release/app/feldspar");

  const auto found = circumstances.find(name);
  const Circumstances here = found == circumstances.end() ? Circumstances() : found->second;
  std::string environment = "FELDSPAR_PROGRAM='" FELDSPAR_COMMAND "' ";
  if (here.pieces)
    environment += fmt::format("FELDSPAR_PIECE='{}' ", fmt::join(*here.pieces, "\n"));
  const auto run = [&](const std::string& commands) {
    expect_to_run(folder, commands, in_pieces, environment + "timeout 120");
  };

  const Page page = read_page(tree / name);
  for (const Block& block : page.blocks)
    {
      // Python is run by tests/python/pages_test.py; lines of CMake and C++ are those of examples/library.
      const std::set<std::string> known{"sh", "text", "python", "cmake", "cpp"};
      EXPECT_TRUE(known.contains(block.language)) << name << ": in no language of pages:\n" << block.text;
      if (!block.file.empty())
        folder.write(block.file, block.text);
      if (block.file.ends_with(".prm"))
        run("feldspar parameters --check " + block.file + "\n");
    }
  run(here.before);
  std::set<std::string> not_run;
  for (const NotRun& one : commands_not_run)
    if (one.page == name)
      not_run.insert(one.command);
  for (const std::string& command : commands_of(page))
    if (not_run.contains(command))
      {
        expect_files(command);
        not_run.erase(command);
      }
    else if (is_run(command))
      run(command + "\n");
    else
      ADD_FAILURE() << name << ": neither run nor listed with a reason: " << command;
  EXPECT_TRUE(not_run.empty()) << name << " has no such command: " << fmt::format("{}", fmt::join(not_run, "; "));
}

INSTANTIATE_TEST_SUITE_P(Pages, CommandsOfPage, testing::ValuesIn(pages_with_blocks()),
                         [](const auto& page) { return name_of_page(page.param); });

TEST(CommandsInSentences, AndTheirOptionsAreKnown)
{
  static const std::regex quoted("`(feldspar [^`]+)`");
  const TemporaryFolder folder;
  std::map<std::string, Outcome> help; // of each command
  std::size_t n_quoted = 0;
  for (const std::string& name : pages())
    {
      const std::string prose = read_page(tree / name).prose;
      for (std::sregex_iterator match(prose.begin(), prose.end(), quoted), end; match != end; ++match, ++n_quoted)
        {
          const auto words = words_of((*match)[1]);
          const std::string& command = words.at(1);
          if (!help.contains(command))
            help[command] = run_feldspar(folder, "help '" + command + "'");
          EXPECT_EQ(help[command].exit_code, 0) << name << ": " << (*match)[1] << "\n" << help[command].error;
          const auto known = words_of(help[command].output);
          for (const std::string& word : words)
            {
              const bool is_known =
                !word.starts_with("--") || std::find(known.begin(), known.end(), word) != known.end();
              EXPECT_TRUE(is_known) << name << ": " << (*match)[1] << "\n" << help[command].output;
            }
        }
    }
  EXPECT_GT(n_quoted, 50u);
}

TEST(CommandsNotRun, AreOfPagesWithBlocks)
{
  const auto names = pages_with_blocks();
  for (const NotRun& one : commands_not_run)
    EXPECT_TRUE(std::find(names.begin(), names.end(), one.page) != names.end()) << one.page << ": " << one.command;
  for (const auto& [name, here] : circumstances)
    EXPECT_TRUE(std::find(names.begin(), names.end(), name) != names.end()) << name;
}
} // namespace feldspar::tests

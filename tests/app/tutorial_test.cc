// Every command of docs/tutorials and of docs/recipes.md, with the files as they are printed there.

#include "tests/app/page_blocks.h"
#include "tests/app/run_command.h"
#include "tests/content.h"
#include "tests/temporary_folder.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cstdlib>
#include <filesystem>
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

void expect_to_run_as_printed(const fs::path& page)
{
  const TemporaryFolder folder;
  const TemporaryFolder path;
  fs::create_symlink(FELDSPAR_COMMAND, path.path() / "feldspar");
  // As root too, and on cores that are fewer than ranks.
  fs::create_symlink(fs::path(FELDSPAR_SOURCE_DIR) / "tests/app/in_pieces/mpirun", path.path() / "mpirun");
  const std::string environment = "FELDSPAR_PROGRAM='" FELDSPAR_COMMAND "'";
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

class Tutorial : public testing::TestWithParam<std::string>
{
};
} // namespace

TEST_P(Tutorial, RunsAsItIsPrinted)
{
  expect_to_run_as_printed(docs / "tutorials" / GetParam());
  EXPECT_NE(content(docs / "tutorials/index.md").find("(" + GetParam() + ")"), std::string::npos)
    << "docs/tutorials/index.md";
}

INSTANTIATE_TEST_SUITE_P(Pages, Tutorial, testing::ValuesIn(tutorials()),
                         [](const auto& page) { return name_of_page(page.param); });

TEST(Recipes, RunAsTheyArePrinted) { expect_to_run_as_printed(docs / "recipes.md"); }
} // namespace feldspar::tests

// Every command of docs/tutorials, with the files as they are printed there.

#include "tests/app/run_command.h"
#include "tests/temporary_folder.h"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cctype>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <sstream>
#include <string>
#include <vector>

namespace feldspar::tests
{
namespace
{
namespace fs = std::filesystem;

const fs::path tutorials = fs::path(FELDSPAR_SOURCE_DIR) / "docs/tutorials";

/// What stands between fences: files (```text NAME) and commands (```sh), in their order.
struct Block
{
  std::string file; ///< empty: commands
  std::string text;
};

std::vector<Block> blocks(const fs::path& page)
{
  std::ifstream in(page);
  std::vector<Block> found;
  bool inside = false;
  for (std::string line; std::getline(in, line);)
    if (line.starts_with("```"))
      {
        inside = !inside;
        if (inside)
          {
            const bool is_file = line.starts_with("```text ");
            EXPECT_TRUE(is_file || line == "```sh") << page << ": " << line;
            found.push_back({is_file ? line.substr(8) : "", ""});
          }
      }
    else if (inside)
      found.back().text += line + "\n";
  return found;
}

std::vector<std::string> pages()
{
  std::vector<std::string> names;
  for (const auto& entry : fs::directory_iterator(tutorials))
    if (entry.path().stem() != "index")
      names.push_back(entry.path().stem());
  std::sort(names.begin(), names.end());
  return names;
}

class Tutorial : public testing::TestWithParam<std::string>
{
};
} // namespace

TEST_P(Tutorial, RunsAsItIsPrinted)
{
  const TemporaryFolder folder;
  // `feldspar` is what a reader types.
  fs::create_directory(folder.path() / "bin");
  fs::create_symlink(FELDSPAR_COMMAND, folder.path() / "bin/feldspar");
  std::size_t n_commands = 0;
  for (const Block& block : blocks(tutorials / (GetParam() + ".md")))
    if (!block.file.empty())
      folder.write(block.file, block.text);
    else
      {
        folder.write("commands", "export PATH=\"$PWD/bin:$PATH\"\nset -e -o pipefail\n" + block.text);
        const auto outcome = run_feldspar(folder.path(), "", "bash ./commands");
        EXPECT_EQ(outcome.exit_code, 0) << block.text << outcome.output << outcome.error;
        ++n_commands;
      }
  EXPECT_GT(n_commands, 0u);
  const std::string index = [&] {
    std::ifstream in(tutorials / "index.md");
    return std::string{std::istreambuf_iterator<char>(in), {}};
  }();
  EXPECT_NE(index.find("(" + GetParam() + ".md)"), std::string::npos) << "docs/tutorials/index.md";
}

INSTANTIATE_TEST_SUITE_P(Pages, Tutorial, testing::ValuesIn(pages()), [](const auto& page) {
  std::string name = page.param;
  std::replace(name.begin(), name.end(), '-', '_');
  return name;
});
} // namespace feldspar::tests

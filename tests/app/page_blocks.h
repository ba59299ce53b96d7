#pragma once

#include "tests/app/run_command.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cctype>
#include <filesystem>
#include <fstream>
#include <string>
#include <vector>

/// Blocks that a page of the documentation has between its fences, and the way a test runs them.
namespace feldspar::tests
{
struct Block
{
  std::string language; ///< sh, text, python, r
  std::string file;     ///< what stands in the block is the content of this file; empty: of none
  std::string text;
};

struct Page
{
  std::vector<Block> blocks; ///< in their order
  std::string prose;         ///< what stands outside of them
};

inline Page read_page(const std::filesystem::path& file)
{
  std::ifstream in(file);
  EXPECT_TRUE(in) << file;
  Page page;
  bool inside = false;
  for (std::string line; std::getline(in, line);)
    if (line.starts_with("```"))
      {
        inside = !inside;
        if (inside)
          {
            const std::size_t space = std::min(line.find(' '), line.size());
            page.blocks.push_back({line.substr(3, space - 3), line.substr(std::min(space + 1, line.size())), ""});
          }
      }
    else
      (inside ? page.blocks.back().text : page.prose) += line + "\n";
  EXPECT_FALSE(inside) << file << ": a block is open at the end of the page";
  return page;
}

/// Runs commands of a page in `folder` as one script, which ends at the first that fails. `path`: the folder with what a
/// reader calls `feldspar`. `environment`: assignments before the script.
inline void expect_to_run(const std::filesystem::path& folder, const std::string& commands,
                          const std::filesystem::path& path, const std::string& environment = "")
{
  const std::string script = folder.string() + ".commands"; // beside the folder, where a page leaves nothing
  std::ofstream(script) << "export PATH='" << path.string() << "':\"$PATH\"\nset -e -o pipefail\n" << commands;
  const Outcome outcome = run_command(folder, environment + " bash '" + script + "'");
  std::filesystem::remove(script);
  EXPECT_EQ(outcome.exit_code, 0) << commands << outcome.output << outcome.error;
}

/// The name of a test for a page: docs/how-to-add.md is docs_how_to_add.
inline std::string name_of_page(std::string page)
{
  page.resize(page.size() - std::string(".md").size());
  std::replace_if(
    page.begin(), page.end(), [](const unsigned char c) { return std::isalnum(c) == 0; }, '_');
  return page;
}
} // namespace feldspar::tests

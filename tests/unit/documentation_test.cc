// The pages of the documentation point at files, sections and rooms that exist.

#include "dem/lab/protocols/protocols.h"
#include "tests/content.h"
#include "tests/documentation_pages.h"
#include "tests/words.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cctype>
#include <filesystem>
#include <regex>
#include <set>
#include <sstream>
#include <string>
#include <string_view>
#include <vector>

namespace
{
namespace fs = std::filesystem;
using feldspar::tests::content;
using feldspar::tests::documentation_pages;

const fs::path root = FELDSPAR_SOURCE_DIR;

/// Folders of the tree that paths in the documentation begin with.
const std::vector<std::string> top_folders = {"app",        "base",       "benchmarks", "calibration", "coupling",
                                              "dem",        "docs",       "examples",   "fem",         "include",
                                              "interfaces", "laboratory", "library",    "python",      "report",
                                              "results",    "runs",       "scripts",    "tests",       "third_party"};

/// The anchor that a renderer of Markdown gives a heading: lower case, spaces as hyphens, ASCII punctuation left out.
std::string anchor(const std::string_view heading)
{
  std::string name;
  for (const char c : heading)
    if (c == ' ')
      name += '-';
    else if (static_cast<unsigned char>(c) >= 0x80 || std::isalnum(static_cast<unsigned char>(c)) != 0 || c == '-' ||
             c == '_')
      name += char(std::tolower(static_cast<unsigned char>(c)));
  return name;
}

std::set<std::string> anchors(const fs::path& page)
{
  std::set<std::string> found;
  std::istringstream lines(content(page));
  bool code = false;
  for (std::string line; std::getline(lines, line);)
    {
      if (line.starts_with("```"))
        code = !code;
      const std::size_t text = line.find_first_not_of('#');
      if (!code && text != std::string::npos && text > 0 && line[text] == ' ')
        found.insert(anchor(std::string_view(line).substr(text + 1)));
    }
  return found;
}

/// First group of every match.
std::vector<std::string> matches(const std::string& text, const std::regex& pattern)
{
  std::vector<std::string> found;
  for (std::sregex_iterator match(text.begin(), text.end(), pattern), end; match != end; ++match)
    found.push_back((*match)[1]);
  return found;
}
} // namespace

TEST(Documentation, HasTheBodiesOfEveryLaboratoryTest)
{
  const std::string theory = content(root / "docs/theory.md");
  const auto yes_or_no = [](const bool yes) { return yes ? "yes" : "–"; };
  for (const auto* protocol : feldspar::laboratory_protocols())
    {
      EXPECT_TRUE(protocol->set_up<2>() && protocol->set_up<3>())
        << protocol->kind.name; // as the sentence above the table says
      std::ostringstream row;
      row << yes_or_no(protocol->takes_cylinders) << " | " << yes_or_no(protocol->takes_clumps) << " | "
          << yes_or_no(protocol->kind.runs_on_finite_elements) << " |";
      const std::size_t begin = theory.find("| `" + std::string(protocol->kind.name) + "` | 4.");
      ASSERT_NE(begin, std::string::npos) << protocol->kind.name;
      const std::string line = theory.substr(begin, theory.find('\n', begin) - begin);
      EXPECT_TRUE(line.ends_with(row.str())) << line << " instead of " << row.str();
    }
}

TEST(Documentation, LinksLeadSomewhere)
{
  static const std::regex link(R"(\]\(([^)\s]+)\))");
  std::size_t n_links = 0;
  for (const fs::path& page : documentation_pages(root))
    for (const std::string& target : matches(content(page), link))
      {
        if (target.starts_with("http"))
          continue;
        const std::size_t hash = target.find('#');
        const std::string file = target.substr(0, hash);
        const fs::path there = file.empty() ? page : page.parent_path() / file;
        EXPECT_TRUE(fs::exists(there)) << page << ": " << target;
        if (hash != std::string::npos && there.extension() == ".md")
          {
            EXPECT_TRUE(anchors(there).contains(target.substr(hash + 1))) << page << ": no such section: " << target;
          }
        ++n_links;
      }
  EXPECT_GT(n_links, 50u);
}

// `folder/file` in a page names a file, a folder, or, without an ending, a program made of the file.
TEST(Documentation, FilesNamedInPagesExist)
{
  static const std::regex quoted(R"(`([A-Za-z0-9_]+(?:/[A-Za-z0-9_.-]+)+/?)`)");
  std::size_t n_files = 0;
  for (const fs::path& page : documentation_pages(root))
    {
      if (page.filename() == "CHANGELOG.md")
        continue; // speaks of earlier trees too
      for (const std::string& name : matches(content(page), quoted))
        if (std::find(top_folders.begin(), top_folders.end(), name.substr(0, name.find('/'))) != top_folders.end())
          {
            const bool beside = fs::exists(page.parent_path() / name); // results/ of an example
            EXPECT_TRUE(fs::exists(root / name) || fs::exists(root / (name + ".cc")) || beside) << page << ": " << name;
            ++n_files;
          }
    }
  EXPECT_GT(n_files, 40u);
}

TEST(Documentation, EveryRoomStandsOnTheCodeMap)
{
  const std::string map = content(root / "docs/code-map.md");
  for (const char* top : {"app", "base", "calibration", "coupling", "dem", "fem", "laboratory", "report", "results"})
    for (const auto& entry : fs::recursive_directory_iterator(root / top))
      if (entry.path().extension() == ".h")
        {
          const std::string room = fs::relative(entry.path().parent_path(), root).string();
          EXPECT_TRUE(feldspar::tests::has(map, "`" + room + "`")) << "docs/code-map.md has no line for " << room;
        }
}

/// Words of a page outside its blocks of code; bars of tables are none.
std::size_t n_words(const fs::path& page)
{
  std::istringstream lines(content(page));
  std::size_t n = 0;
  bool code = false;
  for (std::string line; std::getline(lines, line);)
    {
      if (line.starts_with("```"))
        code = !code;
      std::istringstream words(code ? "" : line);
      for (std::string word; words >> word;)
        if (std::any_of(word.begin(), word.end(),
                        [](const unsigned char c) { return c >= 0x80 || std::isalnum(c) != 0; }))
          ++n;
    }
  return n;
}

// A reader has time for a page. References, the theory and the report of a finding are read by their headings.
TEST(Documentation, PagesAreShort)
{
  EXPECT_LE(n_words(root / "README.md"), 600u);
  EXPECT_LE(content(root / "CHANGELOG.md").size(), 15'000u);
  const std::set<std::string> longer = {"multiscale-and-grains.md", "parameters.md", "results.md", "theory.md"};
  for (const fs::path& page : documentation_pages(root))
    if (page.parent_path().filename() == "docs" && !longer.contains(page.filename().string()))
      {
        EXPECT_LE(n_words(page), 1500u) << page;
      }
}

// `Suite.Test` in docs/reliability.md is a test, and `scripts/...` a script.
TEST(Documentation, TestsThatPromisesStandOnExist)
{
  static const std::regex test(R"re(\b(?:TEST|TEST_F|TEST_P|TYPED_TEST)\(\s*(\w+\s*,\s*\w+)\s*\))re");
  std::set<std::string> tests;
  for (const char* folder : {"tests/unit", "tests/app", "tests/verification", "tests/fuzz"})
    for (const auto& entry : fs::directory_iterator(root / folder))
      if (entry.path().extension() == ".cc")
        for (std::string name : matches(content(entry.path()), test))
          {
            name.erase(std::remove_if(name.begin(), name.end(), [](const char c) { return std::isspace(c) != 0; }),
                       name.end());
            name[name.find(',')] = '.';
            tests.insert(name);
          }
  static const std::regex named(R"(`([A-Z]\w*\.[A-Z]\w*)`)");
  const auto all_named = matches(content(root / "docs/reliability.md"), named);
  EXPECT_GT(all_named.size(), 30u);
  for (const std::string& name : all_named)
    EXPECT_TRUE(tests.contains(name)) << "docs/reliability.md: there is no test " << name;
}

// One direction of dependence: app -> {report, coupling} -> {dem, fem}; dem and fem never meet.

#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <istream>
#include <regex>
#include <sstream>
#include <string>
#include <string_view>
#include <vector>

namespace
{
namespace fs = std::filesystem;

/// What the files of a folder must not include, given as beginnings of paths, and the headers let through all the same.
struct Rule
{
  std::string folder;
  std::vector<std::string> forbidden;
  std::vector<std::string> allowed = {};
};

const std::vector<Rule> rules = {
  {"dem", {"fem/", "coupling/", "report/", "app/", "deal.II/"}},
  {"fem", {"dem/", "coupling/", "report/", "app/"}},
  {"coupling", {"report/", "app/"}},
  {"report",
   {"app/", "dem/"},
   {"dem/lab_results.h", "dem/parameters.h", "dem/input_error.h", "dem/whole_file.h",
    "dem/hdf5_archive.h"}}, // plain data and files only
  {"app", {}},
  {"benchmarks", {"app/"}},
  {"tests", {}},
};

/// Headers of ours that belong to no folder: written by the build.
const std::vector<std::string> generated = {"feldspar_version.h"};

struct Include
{
  std::size_t line;
  std::string path;
  bool quoted;
};

std::vector<Include> includes_of(std::istream& source)
{
  static const std::regex directive(R"(^\s*#\s*include\s*([<"])([^>"]+)[>"].*)");
  std::vector<Include> includes;
  std::string line;
  std::smatch match;
  for (std::size_t number = 1; std::getline(source, line); ++number)
    if (std::regex_match(line, match, directive))
      includes.push_back({number, match[2], match[1] == "\""});
  return includes;
}

bool is_any_of(const std::string_view path, const std::vector<std::string>& paths)
{
  return std::find(paths.begin(), paths.end(), path) != paths.end();
}

/// Why a file of the rule's folder must not have this include; empty when it may.
std::string objection(const Rule& rule, const Include& include)
{
  if (is_any_of(include.path, rule.allowed) || is_any_of(include.path, generated))
    return "";
  for (const std::string& beginning : rule.forbidden)
    if (include.path.starts_with(beginning))
      return rule.folder + "/ must not include " + include.path;
  // A path such as "../fem/mesh.h" would get past the rules above.
  const bool from_the_root = std::any_of(
    rules.begin(), rules.end(), [&](const Rule& other) { return include.path.starts_with(other.folder + "/"); });
  const bool dotted = include.path.find("..") != std::string::npos;
  if ((include.quoted && !from_the_root) || dotted)
    return include.path + ": give headers of the project from its root, as in \"dem/vector.h\"";
  return "";
}

std::vector<std::string> violations(const Rule& rule, const std::string& name, std::istream& source)
{
  std::vector<std::string> found;
  for (const Include& include : includes_of(source))
    if (const std::string reason = objection(rule, include); !reason.empty())
      found.push_back(name + ":" + std::to_string(include.line) + ": " + reason);
  return found;
}

std::size_t n_violations(const Rule& rule, const std::string& text)
{
  std::istringstream source(text);
  return violations(rule, "synthetic", source).size();
}

const Rule& rule_of(const std::string& folder)
{
  return *std::find_if(rules.begin(), rules.end(), [&](const Rule& rule) { return rule.folder == folder; });
}
} // namespace

TEST(IncludeRules, HoldInTheSourceTree)
{
  const fs::path root = FELDSPAR_SOURCE_DIR;
  std::size_t n_includes_in_dem = 0;
  for (const Rule& rule : rules)
    {
      if (!fs::exists(root / rule.folder))
        continue;
      for (const fs::directory_entry& entry : fs::recursive_directory_iterator(root / rule.folder))
        {
          const fs::path extension = entry.path().extension();
          if (extension != ".h" && extension != ".cc")
            continue;
          std::ifstream source(entry.path());
          ASSERT_TRUE(source) << entry.path();
          for (const std::string& violation : violations(rule, fs::relative(entry.path(), root).string(), source))
            ADD_FAILURE() << violation;
          if (rule.folder == "dem")
            {
              source.clear();
              source.seekg(0);
              n_includes_in_dem += includes_of(source).size();
            }
        }
    }
  EXPECT_GT(n_includes_in_dem, 10u) << "nothing was scanned under " << root;
}

TEST(IncludeRules, SeeWhatIsForbidden)
{
  EXPECT_EQ(n_violations(rule_of("dem"), "#include \"fem/mesh.h\"\n"), 1u);
  EXPECT_EQ(n_violations(rule_of("dem"), "#pragma once\n  #  include <deal.II/base/point.h> // geometry\n"), 1u);
  EXPECT_EQ(n_violations(rule_of("dem"), "#include \"report/table.h\"\n#include \"app/lab.h\"\n"), 2u);
  EXPECT_EQ(n_violations(rule_of("dem"), "#include \"../fem/mesh.h\"\n"), 1u);
  EXPECT_EQ(n_violations(rule_of("dem"), "#include \"dem/../fem/mesh.h\"\n"), 1u);
  EXPECT_EQ(n_violations(rule_of("dem"), "#include \"mesh.h\"\n"), 1u);
  EXPECT_EQ(n_violations(rule_of("fem"), "#include \"dem/grains.h\"\n"), 1u);
  EXPECT_EQ(n_violations(rule_of("coupling"), "#include <report/table.h>\n"), 1u);
  EXPECT_EQ(n_violations(rule_of("report"), "#include \"dem/grains.h\"\n"), 1u);
  EXPECT_EQ(n_violations(rule_of("benchmarks"), "#include \"app/lab.h\"\n"), 1u);
}

TEST(IncludeRules, LetTheRestThrough)
{
  EXPECT_EQ(n_violations(rule_of("dem"), "#include \"dem/grains.h\"\n#include <vector>\n// #include \"fem/mesh.h\"\n"),
            0u);
  EXPECT_EQ(n_violations(rule_of("report"), "#include \"dem/lab_results.h\"\n#include \"report/table.h\"\n"), 0u);
  EXPECT_EQ(n_violations(rule_of("app"), "#include \"feldspar_version.h\"\n#include <deal.II/base/mpi.h>\n"), 0u);
  EXPECT_EQ(n_violations(rule_of("tests"), "#include \"app/quantity.h\"\n"), 0u);
}

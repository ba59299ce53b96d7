// One direction of dependence, room by room: app -> {report, calibration, runs} -> coupling -> {results, dem, fem}
// -> laboratory -> base; dem and fem never meet below coupling/sample, dem and results never below runs.

#include "tests/words.h"
#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <istream>
#include <map>
#include <regex>
#include <set>
#include <sstream>
#include <string>
#include <string_view>
#include <vector>

namespace
{
namespace fs = std::filesystem;

/// A room of the house: a folder, and the rooms whose headers its files may include; itself always.
struct Room
{
  std::string folder;
  std::vector<std::string> sees;
};

// From the ground up: a room sees rooms above its own line only, so that no two of them depend on each other.
const std::vector<Room> rooms = {
  {"base", {}},
  {"base/checksum", {"base"}},
  {"base/system", {"base", "base/checksum"}},
  {"base/ranks", {"base"}},
  {"base/table", {"base"}},
  {"laboratory", {"base", "base/table"}},
  {"dem/laws", {"base"}},
  {"dem/storage", {"base", "dem/laws"}},
  {"dem/specimen", {"base", "base/system", "base/table", "laboratory", "dem/laws", "dem/storage"}},
  {"dem/sharing", {"base", "dem/storage", "dem/specimen"}},
  {"dem/minerals", {"base", "dem/storage", "dem/specimen"}},
  {"dem/flaws", {"base", "dem/laws", "dem/storage", "dem/specimen", "dem/minerals"}},
  {"dem/dynamics/sweeps", {"base", "laboratory", "dem/laws", "dem/storage", "dem/specimen"}},
  {"dem/dynamics",
   {"base", "base/system", "laboratory", "dem/laws", "dem/storage", "dem/specimen", "dem/sharing",
    "dem/dynamics/sweeps"}},
  {"dem/genesis", {"base", "base/table", "dem/laws", "dem/storage", "dem/specimen", "dem/dynamics"}},
  {"dem/rock", {"base", "dem/laws", "dem/storage", "dem/specimen", "dem/minerals", "dem/flaws", "dem/genesis"}},
  {"dem/lab",
   {"base", "base/system", "laboratory", "dem/laws", "dem/storage", "dem/specimen", "dem/sharing", "dem/flaws",
    "dem/dynamics"}},
  {"dem/lab/protocols",
   {"base", "laboratory", "dem/laws", "dem/storage", "dem/specimen", "dem/flaws", "dem/dynamics", "dem/lab"}},
  {"results", {"base", "base/system", "laboratory"}},
  {"results/evaluation", {"base", "laboratory", "results"}},
  {"results/runs", {"base", "laboratory", "results"}},
  {"results/fits", {"base", "laboratory", "results", "results/runs"}},
  {"results/folder", {"base", "base/table", "laboratory", "results", "results/runs", "results/fits"}},
  {"calibration", {"base", "laboratory", "results", "results/runs", "results/fits", "results/folder"}},
  {"fem/mesh", {"base", "base/system"}},
  {"fem/materials", {"base"}},
  {"fem/solid", {"base", "fem/mesh", "fem/materials"}},
  {"fem", {"base", "base/system", "fem/mesh", "fem/materials", "fem/solid"}},
  {"coupling/network", {"base", "dem/laws", "dem/storage", "dem/specimen"}},
  {"coupling/rve",
   {"coupling/network", "base", "base/checksum", "base/system", "dem/laws", "dem/storage", "dem/specimen",
    "dem/dynamics"}},
  {"coupling/sample/continua", {"base", "fem/materials"}},
  {"coupling/sample",
   {"coupling/sample/continua", "base", "base/checksum", "base/system", "base/ranks", "laboratory", "dem/laws",
    "dem/storage", "dem/specimen", "fem", "fem/mesh", "fem/materials", "fem/solid", "coupling/rve",
    "coupling/network"}},
  {"runs",
   {"base", "base/system", "base/ranks", "laboratory", "dem/laws", "dem/storage", "dem/specimen", "dem/minerals",
    "dem/sharing", "dem/dynamics", "dem/lab", "dem/lab/protocols", "results", "results/runs", "coupling/network",
    "coupling/rve", "coupling/sample"}},
  {"report/chart", {"base"}},
  {"report/pictures",
   {"base", "base/system", "laboratory", "results", "results/runs", "results/fits", "results/folder", "report/chart"}},
  {"report/pictures/maps", {"base", "laboratory", "results", "results/runs", "report/chart", "report/pictures"}},
  {"report/pictures/curves", {"base", "laboratory", "results", "results/runs", "report/chart", "report/pictures"}},
  {"report/page",
   {"base", "base/system", "results", "results/runs", "results/folder", "report/chart", "report/pictures"}},
  {"report/sections",
   {"base", "laboratory", "results", "results/runs", "results/fits", "results/folder", "report/pictures",
    "report/pictures/curves", "report/pictures/maps", "report/page"}},
  {"report",
   {"base", "base/system", "results", "results/runs", "results/fits", "results/folder", "report/pictures",
    "report/page", "report/sections"}},
};

/// The rooms of the command, which may include all libraries, from the ground up; each sees those before it.
const std::vector<std::string> rooms_of_the_command = {"app/processes", "app/input/maps",  "app/input/curves",
                                                       "app/input",     "app/screen",      "app/run",
                                                       "app/programme", "app/calibration", "app/commands"};

/// Folders that may include any room, but for those named.
const std::vector<std::string> above_all = {"app", "benchmarks", "interfaces", "library", "python", "tests"};

/// Rooms that may include headers of deal.II; no others may.
const std::vector<std::string> rooms_of_finite_elements = {"fem", "coupling/sample", "app/processes", "tests",
                                                           "benchmarks"};

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

const Room* room_of(const std::string_view folder)
{
  const auto room = std::find_if(rooms.begin(), rooms.end(), [&](const Room& one) { return one.folder == folder; });
  return room == rooms.end() ? nullptr : &*room;
}

std::string folder_of(const std::string_view path) { return fs::path(path).parent_path().string(); }

bool is_ours(const std::string_view path)
{
  const std::string top = folder_of(path).substr(0, folder_of(path).find('/'));
  return is_any_of(top, above_all) || std::any_of(rooms.begin(), rooms.end(), [&](const Room& room) {
           return room.folder.substr(0, room.folder.find('/')) == top;
         });
}

bool lies_in(const std::string_view folder, const std::vector<std::string>& folders)
{
  return std::any_of(folders.begin(), folders.end(),
                     [&](const std::string& outer) { return folder == outer || folder.starts_with(outer + "/"); });
}

/// Why a file in this folder must not have this include; empty when it may.
std::string objection(const std::string& folder, const Include& include)
{
  if (is_any_of(include.path, generated))
    return "";
  // A path such as "../fem/mesh.h" would get past the rules.
  if (include.path.find("..") != std::string::npos || (include.quoted && !is_ours(include.path)))
    return include.path + ": give headers of the project from its root, as in \"base/vector.h\"";
  const std::string forbidden = folder + "/ must not include " + include.path;
  if (include.path.starts_with("deal.II/"))
    return lies_in(folder, rooms_of_finite_elements) ? "" : forbidden;
  if (!is_ours(include.path))
    return "";
  const std::string from = folder_of(include.path);
  const auto place = std::find(rooms_of_the_command.begin(), rooms_of_the_command.end(), folder);
  if (place != rooms_of_the_command.end() && lies_in(from, {"app"}))
    return std::find(rooms_of_the_command.begin(), place + 1, from) != place + 1 ? "" : forbidden;
  const Room* const room = room_of(folder);
  if (room == nullptr) // app itself, benchmarks, tests
    return folder.starts_with("benchmarks") && lies_in(from, {"app"}) ? forbidden : "";
  return from == folder || is_any_of(from, room->sees) ? "" : forbidden;
}

std::vector<std::string> violations(const std::string& folder, const std::string& name, std::istream& source)
{
  std::vector<std::string> found;
  for (const Include& include : includes_of(source))
    if (const std::string reason = objection(folder, include); !reason.empty())
      found.push_back(name + ":" + std::to_string(include.line) + ": " + reason);
  return found;
}

std::size_t n_violations(const std::string& folder, const std::string& text)
{
  std::istringstream source(text);
  return violations(folder, "synthetic", source).size();
}

const fs::path source_root = FELDSPAR_SOURCE_DIR;

/// Sources and headers below the folders of the project.
std::vector<fs::path> sources()
{
  std::set<std::string> tops(above_all.begin(), above_all.end());
  for (const Room& room : rooms)
    tops.insert(room.folder.substr(0, room.folder.find('/')));
  std::vector<fs::path> found;
  for (const std::string& top : tops)
    for (const fs::directory_entry& entry : fs::recursive_directory_iterator(source_root / top))
      if (entry.path().extension() == ".h" || entry.path().extension() == ".cc")
        found.push_back(fs::relative(entry.path(), source_root));
  return found;
}
} // namespace

TEST(IncludeRules, HoldInTheSourceTree)
{
  std::size_t n_includes = 0;
  for (const fs::path& path : sources())
    {
      const std::string folder = path.parent_path().string();
      EXPECT_TRUE(room_of(folder) != nullptr || lies_in(folder, above_all)) << path << " stands in no room";
      EXPECT_TRUE(!folder.starts_with("app/") || is_any_of(folder, rooms_of_the_command))
        << path << " stands in no room";
      std::ifstream source(source_root / path);
      ASSERT_TRUE(source) << path;
      for (const std::string& violation : violations(folder, path.string(), source))
        ADD_FAILURE() << violation;
      source.clear();
      source.seekg(0);
      n_includes += includes_of(source).size();
    }
  EXPECT_GT(n_includes, 500u) << "next to nothing was scanned under " << source_root;
}

// Two libraries know no grains and have namespaces of their own; all others speak of one rock by one set of names. Named
// groups of functions (flat_joint, simd, plot) stand one level below.
TEST(IncludeRules, NamespacesAreThoseOfTheLibraries)
{
  const std::map<std::string, std::string> own{{"fem", "feldspar::fem"},
                                               {"calibration", "feldspar::calibration"},
                                               {"app/calibration", "feldspar::calibration"}};
  const std::vector<std::string> of_the_input{"calibration/parameters.h", "calibration/entries.h"};
  const std::regex opening(R"(^namespace (feldspar[a-z_:]*)$)");
  std::size_t n_opened = 0;
  for (const fs::path& path : sources())
    {
      const std::string folder = path.parent_path().string();
      if (lies_in(folder, {"tests"}) || is_any_of(path.string(), of_the_input))
        continue; // tests look into all of them
      std::ifstream source(source_root / path);
      std::smatch match;
      for (std::string line; std::getline(source, line);)
        if (std::regex_match(line, match, opening))
          {
            ++n_opened;
            const std::string opened = match[1];
            const auto library =
              std::find_if(own.begin(), own.end(), [&](const auto& one) { return lies_in(folder, {one.first}); });
            const auto has_this_name = [&](const auto& one) { return one.second == opened; };
            EXPECT_TRUE(library == own.end() ? std::none_of(own.begin(), own.end(), has_this_name)
                                             : has_this_name(*library))
              << path << " opens " << opened;
          }
    }
  EXPECT_GT(n_opened, 300u) << "next to nothing was scanned under " << source_root;
}

// A room of more files is not taken in at a glance.
TEST(IncludeRules, NoRoomIsCrowded)
{
  constexpr std::size_t most_files = 28;
  std::map<std::string, std::size_t> n_files;
  for (const fs::path& path : sources())
    ++n_files[path.parent_path().string()];
  for (const auto& [folder, n] : n_files)
    {
      if (!folder.starts_with("tests"))
        {
          EXPECT_LE(n, most_files) << folder;
        }
    }
}

// A file called so reads as a unit test.
TEST(IncludeRules, TestsLieUnderTestsOnly)
{
  for (const fs::path& path : sources())
    EXPECT_TRUE(!path.stem().string().ends_with("_test") || lies_in(path.parent_path().string(), {"tests"})) << path;
}

// Environment, signals and communicators belong to the program: whoever calls a library has its own. A child process may
// give handlers up.
TEST(IncludeRules, OnlyTheProgramSetsItsProcessUp)
{
  const std::vector<std::string> of_a_program{"setenv(",        "putenv(",        "sigaction(",     "signal(",
                                              "MPI_COMM_WORLD", "MPI_COMM_SELF",  "MPI_Init",       "MPI_Finalize",
                                              "MPI_Comm_dup(",  "MPI_Comm_split", "MPI_Comm_create"};
  const std::regex all_processes(R"(\bMPI_COMM_WORLD\b)"); // not OMPI_COMM_WORLD_SIZE
  std::vector<std::string> places;
  for (const fs::path& path : sources())
    {
      const std::string folder = path.parent_path().string();
      if (lies_in(folder, {"tests", "benchmarks"}))
        continue;
      std::ifstream source(source_root / path);
      std::size_t number = 0;
      for (std::string line; std::getline(source, line);)
        {
          const std::string place = path.string() + ":" + std::to_string(++number) + ": " + line;
          line.resize(std::min(line.find("//"), line.size()));
          if (line.find("MPI_COMM_WORLD") != std::string::npos && std::regex_search(line, all_processes))
            places.push_back(place);
          if (lies_in(folder, {"app"}) || line.find("SIG_DFL") != std::string::npos)
            continue;
          for (const std::string& name : of_a_program)
            EXPECT_FALSE(feldspar::tests::has(line, name)) << place;
        }
    }
  EXPECT_EQ(places.size(), 1u) << "one place hands all processes down";
}

// Each room sees rooms above its own line only, so that no two of them can depend on each other.
TEST(IncludeRules, RoomsStandInOneOrder)
{
  for (std::size_t i = 0; i < rooms.size(); ++i)
    for (const std::string& seen : rooms[i].sees)
      EXPECT_TRUE(std::any_of(rooms.begin(), rooms.begin() + std::ptrdiff_t(i),
                              [&](const Room& lower) { return lower.folder == seen; }))
        << rooms[i].folder << " sees " << seen << ", which does not stand before it";
}

TEST(IncludeRules, SeeWhatIsForbidden)
{
  EXPECT_EQ(n_violations("dem/laws", "#include \"fem/mesh/sample_mesh.h\"\n"), 1u);
  EXPECT_EQ(n_violations("dem/laws", "#pragma once\n  #  include <deal.II/base/point.h> // geometry\n"), 1u);
  EXPECT_EQ(n_violations("dem/lab", "#include \"report/page/table.h\"\n#include \"app/input/input.h\"\n"), 2u);
  EXPECT_EQ(n_violations("dem/laws", "#include \"../fem/mesh.h\"\n"), 1u);
  EXPECT_EQ(n_violations("dem/laws", "#include \"dem/../fem/mesh.h\"\n"), 1u);
  EXPECT_EQ(n_violations("dem/laws", "#include \"mesh.h\"\n"), 1u);
  EXPECT_EQ(n_violations("dem/laws", "#include \"dem/storage/grains.h\"\n"), 1u);
  EXPECT_EQ(n_violations("dem/laws", "#include \"laboratory/record.h\"\n"), 1u);
  EXPECT_EQ(n_violations("dem/lab", "#include \"results/quantities.h\"\n"), 1u);
  EXPECT_EQ(n_violations("coupling/sample", "#include \"dem/lab/laboratory_run.h\"\n"), 1u);
  EXPECT_EQ(n_violations("fem/solid", "#include \"dem/storage/grains.h\"\n"), 1u);
  EXPECT_EQ(n_violations("coupling/rve", "#include \"fem/materials/material.h\"\n"), 1u);
  EXPECT_EQ(n_violations("coupling/sample", "#include <report/page/table.h>\n"), 1u);
  EXPECT_EQ(n_violations("results", "#include \"dem/storage/grains.h\"\n"), 1u);
  EXPECT_EQ(n_violations("runs", "#include \"app/input/input.h\"\n#include \"report/report.h\"\n"), 2u);
  EXPECT_EQ(n_violations("report", "#include \"coupling/network/network.h\"\n"), 1u);
  EXPECT_EQ(n_violations("benchmarks", "#include \"app/input/input.h\"\n"), 1u);
  EXPECT_EQ(n_violations("app/run", "#include \"app/programme/lab_run.h\"\n"), 1u);
  EXPECT_EQ(n_violations("app/calibration", "#include \"app/commands/commands.h\"\n"), 1u);
}

TEST(IncludeRules, LetTheRestThrough)
{
  EXPECT_EQ(
    n_violations("dem/specimen", "#include \"dem/storage/grains.h\"\n#include <vector>\n// #include \"fem/mesh.h\"\n"),
    0u);
  EXPECT_EQ(n_violations("report/sections", "#include \"laboratory/record.h\"\n#include \"report/page/table.h\"\n"),
            0u);
  EXPECT_EQ(n_violations("app/processes", "#include \"feldspar_version.h\"\n#include <deal.II/base/mpi.h>\n"), 0u);
  EXPECT_EQ(n_violations("tests/unit", "#include \"base/table/quantity.h\"\n"), 0u);
}

// Files of the user around a run: none is lost, none outside is written, and none that is no file is waited for.

#include "tests/app/run_command.h"
#include "tests/content.h"
#include "tests/temporary_folder.h"

#include <fmt/format.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <chrono>
#include <filesystem>
#include <fstream>
#include <map>
#include <set>
#include <string>
#include <string_view>
#include <thread>
#include <vector>

#include <sys/stat.h>

namespace feldspar::tests
{
namespace
{
namespace fs = std::filesystem;

constexpr const char* path_table = "normal_m,shear_m,rotation_rad\n0,0,0\n-1e-6,0,0\n";
constexpr const char* reference = R"({"experiment": {"tensile_strength_MPa": 9}})";

/// Some sixty grains, pulled apart within a second.
const std::string rock = "subsection Specimen\n  set Width = 8 mm\n  set Height = 12 mm\nend\n"
                         "subsection Tests\n  set List = direct_tension\n  set Tension strain rate = 4 1/s\nend\n";

std::string naming(const std::string& section, const std::string& entry, const std::string& value)
{
  return fmt::format("subsection {}\n  set {} = {}\nend\n", section, entry, value);
}

/// Every file below a folder with its bytes; lists of files are left out.
std::map<std::string, std::string> all_files(const fs::path& folder)
{
  std::map<std::string, std::string> files;
  for (const auto& entry : fs::recursive_directory_iterator(folder))
    if (entry.is_regular_file() && entry.path().filename() != ".feldspar-files")
      files[entry.path().lexically_relative(folder).string()] = content(entry.path());
  return files;
}

/// A refusal: one line with these words, code 2, and not a byte changed.
void expect_refused(const TemporaryFolder& folder, const std::string& arguments, const std::string& words)
{
  const auto before = all_files(folder.path());
  const Outcome outcome = run_feldspar(folder.path(), arguments, "timeout 20");
  EXPECT_EQ(outcome.exit_code, 2) << arguments;
  EXPECT_NE(outcome.error.find(words), std::string::npos) << arguments << ": " << outcome.error;
  EXPECT_EQ(std::count(outcome.error.begin(), outcome.error.end(), '\n'), 1) << outcome.error;
  EXPECT_TRUE(all_files(folder.path()) == before) << arguments << ": files were changed";
}

std::set<std::string> lines_of(const fs::path& file)
{
  std::ifstream stream(file);
  std::set<std::string> lines;
  for (std::string line; std::getline(stream, line);)
    lines.insert(line);
  return lines;
}

TEST(WriteOver, IsRefusedInTheFolderOfTheInput)
{
  const TemporaryFolder folder;
  for (const char* const below : {"rock", "rock/figures", "rock/tables"})
    fs::create_directory(folder.path() / below);
  folder.write("rock/input.prm", rock + naming("Report", "Reference file", "reference.json"));
  folder.write("rock/reference.json", reference);
  folder.write("rock/figures/mine.png", "mine");
  folder.write("rock/tables/mine.csv", "mine");
  const std::string why = "input.prm is read by this run and lies among the results in rock";
  for (const char* const command : {"lab", "multiscale", "rve", "calibrate"})
    expect_refused(folder, fmt::format("{} rock/input.prm --output rock --force", command),
                   command == std::string("lab") ? why : "feldspar: ");
  // Refusals by another name of the same folder, and by a link to the input.
  fs::create_symlink("rock", folder.path() / "same");
  expect_refused(folder, "lab rock/input.prm --output same --force", "input.prm is read by this run");
  folder.write("rock/input.prm", rock);
  fs::create_symlink("rock/input.prm", folder.path() / "link.prm");
  expect_refused(folder, "lab link.prm --output rock --force", "link.prm is read by this run");
  // Without --force the words suggest nothing that would cost a file.
  const Outcome outcome = run_feldspar(folder.path(), "lab rock/input.prm --output rock");
  EXPECT_NE(outcome.error.find("rock: is not empty; choose another folder with --output"), std::string::npos)
    << outcome.error;
  EXPECT_EQ(outcome.error.find("--force"), std::string::npos) << outcome.error;
}

TEST(WriteOver, IsRefusedWhereAFileThatIsReadLiesAmongTheResults)
{
  const TemporaryFolder folder;
  for (const char* const below : {"out", "out/tables", "out/curves"})
    fs::create_directory(folder.path() / below);
  folder.write("out/reference.json", reference);
  folder.write("out/specimen.h5", "kept");
  folder.write("out/contact.csv", path_table);
  folder.write("out/tables/traces.csv", "from_x_m,from_y_m,to_x_m,to_y_m\n0.002,0.004,0.006,0.008\n");
  folder.write("out/curves/packing.txt", "0.002 0.002 0.001\n0.004 0.002 0.001\n");
  folder.write("out/curves/stages.csv", "x\n");
  folder.write("out/tables/core.csv", "x\n");
  const auto expect = [&](const std::string& command, const std::string& more, const std::string& file) {
    folder.write("a.prm", rock + more);
    expect_refused(folder, command + " a.prm --output out --force", file + " is read by this run");
  };
  expect("lab", naming("Report", "Reference file", "out/reference.json"), "out/reference.json");
  expect("lab", naming("Specimen", "Specimen file", "out/specimen.h5"), "out/specimen.h5");
  expect("lab", naming("Specimen", "Packing file", "out/curves/packing.txt"), "out/curves/packing.txt");
  expect("lab", naming("Flaws", "Traces file", "out/tables/traces.csv"), "out/tables/traces.csv");
  expect("specimen", naming("Specimen", "Specimen file", "out/specimen.h5"), "out/specimen.h5");
  expect("contact", naming("Contact path", "File", "out/contact.csv"), "out/contact.csv");
  expect_refused(folder, "report --curve out/tables/core.csv --output out --force", "out/tables/core.csv is read");
}

TEST(WriteOver, IsRefusedWhereNoRunIsKnownToHaveWrittenAFile)
{
  const TemporaryFolder folder;
  fs::create_directory(folder.path() / "out");
  folder.write("a.prm", rock + naming("Contact path", "File", "path.csv"));
  folder.write("path.csv", path_table);
  for (const auto& [name, command] : {std::pair("input.prm", "lab"),
                                      {"reference.json", "lab"},
                                      {"specimen.h5", "specimen"},
                                      {"contact.csv", "contact"}})
    {
      folder.write(fmt::format("out/{}", name), "mine");
      expect_refused(folder, fmt::format("{} a.prm --output out --force", command),
                     fmt::format("no run is known to have written out/{}", name));
      fs::remove(folder.path() / "out" / name);
    }
}

TEST(WriteOver, TakesOutWhatRunsWroteAndNothingElse)
{
  const TemporaryFolder folder;
  folder.write("a.prm", rock + naming("Report", "Reference file", "reference.json"));
  folder.write("b.prm", rock + naming("Seeds", "Seeds", "2"));
  folder.write("reference.json", reference);
  ASSERT_EQ(run_feldspar(folder.path(), "lab a.prm --output out --quiet").exit_code, 0);
  const fs::path out = folder.path() / "out";
  // Every file of a run is on its list.
  std::set<std::string> written;
  for (const auto& [file, bytes] : all_files(out))
    written.insert(file);
  const std::set<std::string> listed = lines_of(out / ".feldspar-files");
  EXPECT_TRUE(std::includes(listed.begin(), listed.end(), written.begin(), written.end()));

  std::map<std::string, std::string> mine;
  fs::create_directory(out / "checkpoints");
  for (const char* const file : {"notes.txt", "figures/mine.png", "tables/mine.csv", "curves/mine.csv",
                                 "grains/mine.csv", "fields/mine.vtp", "checkpoints/mine.h5"})
    {
      folder.write(fmt::format("out/{}", file), file);
      mine[file] = file;
    }
  // The list may be another's: nothing out of the folder, and nothing through a link.
  folder.write("victim.csv", "precious");
  fs::create_directory(folder.path() / "elsewhere");
  folder.write("elsewhere/victim.csv", "precious");
  fs::create_symlink("../elsewhere", out / "linked");
  std::ofstream(out / ".feldspar-files", std::ios::app)
    << "../victim.csv\ntables/../../victim.csv\n"
    << (folder.path() / "victim.csv").string() << "\nlinked/victim.csv\nnotes.txt\ntables\n";

  const Outcome again = run_feldspar(folder.path(), "lab b.prm --output out --force --quiet");
  ASSERT_EQ(again.exit_code, 0) << again.error;
  EXPECT_FALSE(fs::exists(out / "curves/direct_tension_seed_1.csv"));
  EXPECT_FALSE(fs::exists(out / "reference.json")) << "of the run before";
  const auto now = all_files(out);
  for (const auto& [file, bytes] : mine)
    EXPECT_EQ(now.contains(file) ? now.at(file) : "lost", bytes) << file;
  EXPECT_EQ(content(folder.path() / "victim.csv"), "precious");
  EXPECT_EQ(content(folder.path() / "elsewhere/victim.csv"), "precious");

  // A mistake that is found after the list leaves the user's files alone too.
  folder.write("c.prm", rock + naming("Tests", "List", "triaxial_compression"));
  ASSERT_EQ(run_feldspar(folder.path(), "report out --quiet").exit_code, 0);
  const auto after_report = all_files(out);
  for (const auto& [file, bytes] : mine)
    EXPECT_EQ(after_report.contains(file) ? after_report.at(file) : "lost", bytes) << file;
}

// A name of a result in a folder of results, which no run wrote: before any run, beside an earlier run, as a folder.
TEST(WriteOver, KeepsAFileOfTheUserInThePlaceOfAResultAside)
{
  const TemporaryFolder folder;
  folder.write("a.prm", rock);
  for (const char* const below : {"out", "out/tables", "out/curves"})
    fs::create_directory(folder.path() / below);
  folder.write("out/tables/tests.csv", "mine");
  folder.write("out/curves/direct_tension_seed_1.csv", "mine too");
  const Outcome first = run_feldspar(folder.path(), "lab a.prm --output out --force --quiet");
  ASSERT_EQ(first.exit_code, 0) << first.error;
  EXPECT_EQ(content(folder.path() / "out/tables/tests.csv.kept"), "mine");
  EXPECT_EQ(content(folder.path() / "out/curves/direct_tension_seed_1.csv.kept"), "mine too");
  EXPECT_NE(first.error.find("direct_tension_seed_1.csv: no run is known to have written it; it is kept as "
                             "direct_tension_seed_1.csv.kept\n"),
            std::string::npos)
    << first.error;

  folder.write("out/curves/direct_tension_seed_2.csv", "of my second core");
  fs::create_directory(folder.path() / "out/curves/direct_tension_seed_3.csv");
  folder.write("out/curves/direct_tension_seed_3.csv/notes.txt", "a folder of mine");
  const Outcome again =
    run_feldspar(folder.path(), "lab a.prm --set \"Seeds/Seeds = 2..3\" --output out --force --quiet");
  ASSERT_EQ(again.exit_code, 0) << again.error;
  EXPECT_EQ(content(folder.path() / "out/curves/direct_tension_seed_2.csv.kept"), "of my second core");
  EXPECT_EQ(content(folder.path() / "out/curves/direct_tension_seed_3.csv.kept/notes.txt"), "a folder of mine");
  EXPECT_EQ(content(folder.path() / "out/tables/tests.csv.kept"), "mine");

  // A report beside the results asks for no --force, and loses nothing either.
  fs::remove(folder.path() / "out/report.html");
  fs::create_directory(folder.path() / "out/report.html");
  std::ofstream(folder.path() / "out/.feldspar-files") << "run.json\nsummary.json\n";
  ASSERT_EQ(run_feldspar(folder.path(), "report out --quiet").exit_code, 0);
  EXPECT_TRUE(fs::is_directory(folder.path() / "out/report.html.kept"));
  EXPECT_TRUE(fs::exists(folder.path() / "out/tables/tests.csv.kept-2"));
}

// A slot that takes the upper end off is found once the rock is made.
TEST(WriteOver, ThatIsRefusedLaterLeavesTheEarlierRunAsItWas)
{
  const TemporaryFolder folder;
  folder.write("a.prm", rock);
  ASSERT_EQ(run_feldspar(folder.path(), "lab a.prm --output out --quiet").exit_code, 0);
  folder.write("out/tables/mine.csv", "mine");
  const auto before = all_files(folder.path());
  const auto listed = lines_of(folder.path() / "out/.feldspar-files");
  for (const char* const setting :
       {"Flaws/Shapes = slot from 0, 6 mm to 8, 6 mm width 1.5 mm", "Tests/Grip ratio = 0.001"})
    {
      const Outcome outcome =
        run_feldspar(folder.path(), fmt::format("lab a.prm --set \"{}\" --output out --force --quiet", setting));
      EXPECT_EQ(outcome.exit_code, 2) << outcome.error;
      EXPECT_TRUE(all_files(folder.path()) == before) << setting;
      EXPECT_EQ(lines_of(folder.path() / "out/.feldspar-files"), listed);
      EXPECT_FALSE(fs::exists(folder.path() / "out/.feldspar-before"));
    }
}

TEST(WriteOver, NamesAnObstacleByItsOwnName)
{
  const TemporaryFolder folder;
  folder.write("a.prm", rock);
  ASSERT_EQ(run_without_pictures(folder.path(), "lab a.prm --output out --quiet").exit_code, 0);
  fs::rename(folder.path() / "out/tables", folder.path() / "tables");
  folder.write("out/tables", "a file");
  for (const char* const command : {"report out", "lab a.prm --output out --force"})
    expect_refused(folder, command, "out/tables: is a file, where a folder of results is to be; move it elsewhere");
  fs::remove(folder.path() / "out/tables");
  folder.write("victim", "precious");
  fs::rename(folder.path() / "out/.feldspar-files", folder.path() / "list");
  fs::create_symlink("../victim", folder.path() / "out/.feldspar-files");
  expect_refused(folder, "report out", "out/.feldspar-files: is a link");
  // A name that no run of this rock writes is no obstacle.
  fs::create_directory(folder.path() / "mine");
  folder.write("mine/specimen_notes.h5", "notes");
  EXPECT_EQ(run_feldspar(folder.path(), "specimen a.prm --output mine --force --quiet").exit_code, 0);
  EXPECT_EQ(content(folder.path() / "mine/specimen_notes.h5"), "notes");
}

TEST(WriteOver, OfAVersionWithoutListsTakesOutTheKnownNamesAtTheTop)
{
  const TemporaryFolder folder;
  folder.write("a.prm", rock);
  ASSERT_EQ(run_feldspar(folder.path(), "lab a.prm --output out --quiet").exit_code, 0);
  const fs::path out = folder.path() / "out";
  fs::remove(out / ".feldspar-files");
  folder.write("out/figures/mine.png", "mine");
  folder.write("out/specimen_seed_7.h5", "of the earlier run");
  const Outcome offered = run_feldspar(folder.path(), "lab a.prm --output out");
  EXPECT_NE(offered.error.find("(--force replaces the run in it, and keeps all other files)"), std::string::npos)
    << offered.error;
  const Outcome again = run_feldspar(folder.path(), "lab a.prm --output out --force --quiet");
  ASSERT_EQ(again.exit_code, 0) << again.error;
  EXPECT_EQ(content(out / "figures/mine.png"), "mine");
  EXPECT_FALSE(fs::exists(out / "specimen_seed_7.h5"));
  // A report there makes a list, with what the older run wrote.
  fs::remove(out / ".feldspar-files");
  ASSERT_EQ(run_feldspar(folder.path(), "report out --quiet").exit_code, 0);
  EXPECT_TRUE(lines_of(out / ".feldspar-files").contains("run.json"));
  EXPECT_EQ(run_feldspar(folder.path(), "lab a.prm --output out --force --quiet").exit_code, 0);
}

TEST(WriteOver, ReadsAllThatItReadsBeforeItTakesAnythingOut)
{
  const TemporaryFolder folder;
  folder.write("a.prm", rock);
  ASSERT_EQ(run_without_pictures(folder.path(), "lab a.prm --output out --quiet").exit_code, 0);
  folder.write("broken.h5", "no specimen");
  folder.write("b.prm", rock + naming("Specimen", "Specimen file", "broken.h5"));
  expect_refused(folder, "lab b.prm --output out --force", "broken.h5: ");
  folder.write("packing.txt", "0.002 0.002 nothing\n");
  folder.write("b.prm", rock + naming("Specimen", "Packing file", "packing.txt"));
  expect_refused(folder, "lab b.prm --output out --force", "packing.txt:1: ");
}

/// A run whose record says that something is left to be done.
void make_incomplete(const fs::path& folder)
{
  std::string record = content(folder / "run.json");
  const std::string complete = "\"complete\": true";
  ASSERT_NE(record.find(complete), std::string::npos) << record;
  record.replace(record.find(complete), complete.size(), "\"complete\": false");
  std::ofstream(folder / "run.json") << record;
}

TEST(Resume, RefusesAnInputThatIsNotThatOfItsRun)
{
  const TemporaryFolder folder;
  folder.write("a.prm", rock + naming("Report", "Reference file", "reference.json"));
  folder.write("reference.json", reference);
  ASSERT_EQ(run_without_pictures(folder.path(), "lab a.prm --output out --quiet").exit_code, 0);
  make_incomplete(folder.path() / "out");
  const std::string input = content(folder.path() / "out/input.prm");
  for (const std::string& changed : {std::string(), input + "\n"})
    {
      folder.write("out/input.prm", changed);
      expect_refused(folder, "lab --resume out", "out: out/input.prm is not as it was when the run began");
    }
  folder.write("out/input.prm", input);
  folder.write("reference.json", R"({"experiment": {"tensile_strength_MPa": 8}})");
  expect_refused(folder, "lab --resume out", "reference.json is not as it was when the run began");
  fs::remove(folder.path() / "reference.json");
  expect_refused(folder, "lab --resume out", "reference.json: cannot be read: No such file");
  folder.write("reference.json", reference);
  const Outcome resumed = run_without_pictures(folder.path(), "lab --resume out --quiet");
  EXPECT_EQ(resumed.exit_code, 0) << resumed.error;
}

// The folder keeps the input of its run; who edits his own file is told that it is not read.
TEST(Resume, SaysThatAnInputThatHasChangedIsNotRead)
{
  const TemporaryFolder folder;
  folder.write("a.prm", rock);
  ASSERT_EQ(run_without_pictures(folder.path(), "lab a.prm --output out --quiet").exit_code, 0);
  const std::string curve = content(folder.path() / "out/curves/direct_tension_seed_1.csv");
  EXPECT_EQ(run_feldspar(folder.path(), "lab --resume out").error, "");
  folder.write("a.prm", rock + "subsection Seeds\n  set Seeds = 2\nend\n");
  const std::string remark =
    fmt::format("feldspar: {}: has changed since the run began, and is not read; the run goes by out/input.prm\n",
                (fs::canonical(folder.path()) / "a.prm").string());
  EXPECT_EQ(run_without_pictures(folder.path(), "lab --resume out --quiet").error, remark); // of a run that is complete
  make_incomplete(folder.path() / "out");
  const Outcome resumed = run_without_pictures(folder.path(), "lab --resume out --quiet");
  EXPECT_EQ(resumed.exit_code, 0);
  EXPECT_EQ(resumed.error, remark);
  EXPECT_EQ(content(folder.path() / "out/curves/direct_tension_seed_1.csv"), curve);
  fs::remove(folder.path() / "a.prm");
  EXPECT_EQ(run_without_pictures(folder.path(), "lab --resume out --quiet").error, "");
}

TEST(Links, LeadNoWriterOutOfTheFolder)
{
  const TemporaryFolder folder;
  folder.write("a.prm", rock);
  ASSERT_EQ(run_feldspar(folder.path(), "lab a.prm --output out --quiet").exit_code, 0);
  folder.write("victim.txt", "precious");
  fs::create_directory(folder.path() / "outside");
  folder.write("outside/kept.csv", "precious");
  const fs::path out = folder.path() / "out";
  const auto link = [&](const std::string& target, const std::string& name) {
    fs::remove_all(out / name);
    fs::create_symlink(target, out / name);
  };
  // Links in the place of files are replaced, those of temporary files too.
  for (const char* const file : {"report.html", "report.html.unfinished", ".feldspar-files.unfinished"})
    link("../victim.txt", file);
  for (const char* const file :
       {"figures/direct_tension_seed_1_cracks.gp", "figures/direct_tension_seed_1_cracks.gp.unfinished",
        "figures/direct_tension_seed_1_cracks.png", "figures/direct_tension_stress.svg",
        "figures/direct_tension_stress.pdf", "tables/strengths.csv"})
    link("../../victim.txt", file);
  const Outcome report = run_feldspar(folder.path(), "report out --quiet");
  EXPECT_EQ(report.exit_code, 0) << report.error;
  EXPECT_EQ(content(folder.path() / "victim.txt"), "precious");
  for (const char* const file : {"report.html", "figures/direct_tension_seed_1_cracks.png",
                                 "figures/direct_tension_stress.svg", "tables/strengths.csv"})
    EXPECT_TRUE(fs::is_regular_file(fs::symlink_status(out / file))) << file;

  // A resumed run writes tables, fields and its record.
  make_incomplete(out);
  for (const char* const file : {"summary.json", "log.txt", "tests.csv", "run.json.unfinished"})
    link("../victim.txt", file);
  for (const char* const file : {"curves/direct_tension_seed_1.csv", "fields/direct_tension_seed_1_grains.pvd"})
    link("../../victim.txt", file);
  const Outcome resumed = run_feldspar(folder.path(), "lab --resume out --quiet");
  EXPECT_EQ(resumed.exit_code, 0) << resumed.error;
  EXPECT_EQ(content(folder.path() / "victim.txt"), "precious");

  // Links in the place of folders are refused, wherever they lie; a list that is a link, too.
  make_incomplete(out);
  for (const char* const name : {"tables", "figures", "fields/direct_tension_seed_1", "curves"})
    {
      fs::rename(out / name, folder.path() / "aside");
      fs::create_directory_symlink(folder.path() / "outside", out / name);
      for (const char* const command : {"report out", "lab --resume out", "lab a.prm --output out --force"})
        expect_refused(folder, command, fmt::format("out/{}: is a link to another folder", name));
      fs::remove(out / name);
      fs::rename(folder.path() / "aside", out / name);
    }
  EXPECT_EQ(content(folder.path() / "outside/kept.csv"), "precious");
  EXPECT_EQ(all_files(folder.path() / "outside").size(), 1u);
}

/// A place where a reader expects a file: the command, and the name of the file.
struct Reader
{
  std::string command;
  std::string input; ///< of the file a.prm; empty: none
  std::string file;
};

TEST(NoFile, IsRefusedAtOnceByEveryReader)
{
  const TemporaryFolder folder;
  folder.write("run.prm", rock);
  ASSERT_EQ(run_without_pictures(folder.path(), "lab run.prm --output out --quiet").exit_code, 0);
  make_incomplete(folder.path() / "out");
  const std::string stages = naming("Tests", "List", "own_loading");
  const std::vector<Reader> readers{{"lab in.prm", "", "in.prm"},
                                    {"lab in.json", "", "in.json"},
                                    {"parameters --check in.prm", "", "in.prm"},
                                    {"contact a.prm", naming("Contact path", "File", "path.csv"), "path.csv"},
                                    {"lab a.prm", rock + naming("Report", "Reference file", "r.json"), "r.json"},
                                    {"lab a.prm", rock + naming("Report", "Reference results", "s.json"), "s.json"},
                                    {"lab a.prm", rock + naming("Specimen", "Packing file", "p.txt"), "p.txt"},
                                    {"specimen a.prm", rock + naming("Specimen", "Specimen file", "b.h5"), "b.h5"},
                                    {"lab a.prm", rock + naming("Flaws", "Traces file", "t.csv"), "t.csv"},
                                    {"lab a.prm", rock + naming("Flaws", "Traces file", "t.dxf"), "t.dxf"},
                                    {"lab a.prm", naming("Tests", "Loading table", "stages.csv"), "stages.csv"},
                                    {"lab a.prm", rock + naming("Variants", "Table", "v.csv"), "v.csv"},
                                    {"rve a.prm", naming("Strain path", "File", "strain.csv"), "strain.csv"},
                                    {"multiscale a.prm", naming("Sample", "Mesh file", "m.msh"), "m.msh"},
                                    {"report --curve core.csv", "", "core.csv"},
                                    {"report out --reference r.json", "", "r.json"},
                                    {"report out", "", "out/summary.json"},
                                    {"lab --resume out", "", "out/run.json"},
                                    {"lab --resume out", "", "out/input.prm"}};
  for (const Reader& reader : readers)
    for (const char* const kind : {"pipe", "device", "folder"})
      {
        if (!reader.input.empty())
          folder.write("a.prm", reader.input);
        const fs::path file = folder.path() / reader.file;
        const bool was_there = fs::exists(file);
        if (was_there)
          fs::rename(file, folder.path() / "aside");
        if (kind == std::string("pipe"))
          {
            ASSERT_EQ(mkfifo(file.c_str(), 0600), 0);
          }
        else if (kind == std::string("device"))
          fs::create_symlink("/dev/zero", file);
        else
          fs::create_directory(file);
        SCOPED_TRACE(fmt::format("{} {}", kind, reader.file));
        expect_refused(folder, reader.command, fmt::format("is a {}; ", kind));
        fs::remove(file);
        if (was_there)
          fs::rename(folder.path() / "aside", file);
      }
  // A table that is missing costs its curve alone, and so does a pipe in its place.
  fs::remove(folder.path() / "out/curves/direct_tension_seed_1.csv");
  ASSERT_EQ(mkfifo((folder.path() / "out/curves/direct_tension_seed_1.csv").c_str(), 0600), 0);
  const Outcome report = run_feldspar(folder.path(), "report out", "timeout 20");
  EXPECT_EQ(report.exit_code, 0) << report.error;
  EXPECT_NE(report.output.find("direct_tension_seed_1.csv: is a pipe; "), std::string::npos) << report.output;
}

/// A control character but for the line's end.
bool has_control(const std::string& text)
{
  return std::any_of(text.begin(), text.end(),
                     [](const char c) { return (static_cast<unsigned char>(c) < 0x20 && c != '\n') || c == 0x7f; });
}

TEST(CommandLine, IsToldInOneShortPrintableLineWhateverIsInIt)
{
  const TemporaryFolder folder;
  folder.write("a.prm", rock);
  const std::string escape = R"sh("$(printf 'a\033]0;x\007\033[31m\nb')")sh";
  const std::string longest = R"sh("$(head -c 100000 /dev/zero | tr '\0' y)")sh";
  for (const std::string& word : {escape, longest})
    for (const std::string& arguments :
         {word, "--" + word, "lab --" + word, "lab a.prm " + word, "lab a.prm --threads " + word, "help " + word,
          "parameters --check a.prm --for " + word, "parameters " + word, "lab " + word, "lab --resume " + word,
          "lab a.prm --set " + word, "lab a.prm --output a.prm/" + word, "report " + word, "report --curve " + word,
          "report a --reference " + word, "multiscale a.prm --extract " + word})
      {
        const Outcome outcome = run_feldspar(folder.path(), arguments);
        EXPECT_TRUE(outcome.exit_code == 2 || outcome.exit_code == 3) << arguments << outcome.exit_code;
        EXPECT_EQ(std::count(outcome.error.begin(), outcome.error.end(), '\n'), 1) << arguments << outcome.error;
        EXPECT_FALSE(has_control(outcome.error)) << arguments;
        // "feldspar: ", 2000 characters and the line's end; an ellipsis takes three bytes.
        EXPECT_LE(outcome.error.size(), 2015u) << arguments;
      }
  const Outcome unknown = run_feldspar(folder.path(), "lab a.prm --" + longest);
  EXPECT_LT(unknown.error.size(), 800u);
  EXPECT_NE(unknown.error.find("; see feldspar lab --help"), std::string::npos) << unknown.error;
}

TEST(Report, SaysInOneLineThatManyTestsAreMissing)
{
  const TemporaryFolder folder;
  folder.write("a.prm", rock);
  ASSERT_EQ(run_without_pictures(folder.path(), "lab a.prm --output out --quiet").exit_code, 0);
  auto summary = nlohmann::ordered_json::parse(content(folder.path() / "out/summary.json"));
  const auto test = summary["tests"][0];
  constexpr std::size_t n = 1000;
  for (std::size_t k = 2; k <= n; ++k)
    {
      summary["tests"].push_back(test);
      summary["tests"].back()["name"] = fmt::format("direct_tension_seed_{}", k);
      summary["tests"].back()["seed"] = k;
    }
  folder.write("out/summary.json", summary.dump());
  const Outcome report = run_feldspar(folder.path(), "report out --reference none.json");
  EXPECT_EQ(report.exit_code, 2);
  const Outcome many = run_feldspar(folder.path(), "report out");
  ASSERT_EQ(many.exit_code, 0) << many.error;
  const std::string missing = "cannot be read: No such file";
  EXPECT_NE(many.output.find(fmt::format("{} or directory (and {} more like it)", missing, 2 * (n - 1) - 1)),
            std::string::npos)
    << many.output.substr(0, 4000);
  EXPECT_EQ(many.output.find(missing), many.output.rfind(missing));
  EXPECT_LE(std::count(many.output.begin(), many.output.end(), '\n'), 4) << many.output.substr(0, 4000);
}

TEST(EqualRuns, HaveEqualFilesOfHdf5)
{
  const TemporaryFolder folder;
  folder.write("a.prm", rock);
  const std::string sample = "subsection Sample\n  set Material = linear elasticity\n  set Width = 12 mm\n"
                             "  set Height = 24 mm\n  set Elements across = 1\n  set Elements along = 2\nend\n"
                             "subsection Tests\n  set List = uniaxial_compression\n  set Stop strain = 1e-4\nend\n";
  folder.write("b.prm", sample);
  for (const char* const which : {"1", "2"})
    {
      ASSERT_EQ(run_feldspar(folder.path(), fmt::format("specimen a.prm --output grains{} --quiet", which)).exit_code,
                0);
      const Outcome run = run_feldspar(folder.path(), fmt::format("multiscale b.prm --output sample{} --quiet", which));
      ASSERT_EQ(run.exit_code, 0) << run.error;
      std::this_thread::sleep_for(std::chrono::milliseconds(1100)); // times in such files have seconds
    }
  std::size_t n = 0;
  for (const char* const of : {"grains", "sample"})
    for (const auto& [file, bytes] : all_files(folder.path() / (of + std::string("1"))))
      if (file.ends_with(".h5") &&
          !file.starts_with("states/")) // a state has its computing time, for the run that goes on
        {
          ++n;
          EXPECT_TRUE(content(folder.path() / (of + std::string("2")) / file) == bytes) << file;
        }
  EXPECT_GE(n, 3u);
}
} // namespace
} // namespace feldspar::tests

// Files of the user around a run: none is lost, none outside is written, and none that is no file is waited for.

#include "tests/app/result_files.h"
#include "tests/app/run_command.h"
#include "tests/temporary_folder.h"

#include <fmt/format.h>
#include <gtest/gtest.h>

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
const std::string rock = section("Specimen", "Width = 8 mm", "Height = 12 mm") +
                         section("Tests", "List = direct_tension", "Tension strain rate = 4 1/s");

std::set<std::string> lines_of(const fs::path& file)
{
  std::istringstream stream(content(file));
  std::set<std::string> lines;
  for (std::string line; std::getline(stream, line);)
    lines.insert(line);
  return lines;
}

TEST(WriteOver, IsRefusedInTheFolderOfTheInput)
{
  const TemporaryFolder folder;
  for (const char* const below : {"rock", "rock/figures", "rock/tables"})
    fs::create_directory(folder / below);
  folder.write("rock/input.prm", rock + section("Report", "Reference file = reference.json"));
  folder.write("rock/reference.json", reference);
  folder.write("rock/figures/mine.png", "mine");
  folder.write("rock/tables/mine.csv", "mine");
  const std::string why = "input.prm is read by this run and lies among the results in rock";
  for (const char* const command : {"lab", "multiscale", "rve", "calibrate"})
    expect_refused(folder, fmt::format("{} rock/input.prm --output rock --force", command),
                   command == std::string("lab") ? why : "feldspar: ");
  // Refusals by another name of the same folder, and by a link to the input.
  fs::create_symlink("rock", folder / "same");
  expect_refused(folder, "lab rock/input.prm --output same --force", "input.prm is read by this run");
  folder.write("rock/input.prm", rock);
  fs::create_symlink("rock/input.prm", folder / "link.prm");
  expect_refused(folder, "lab link.prm --output rock --force", "link.prm is read by this run");
  // Without --force the words suggest nothing that would cost a file.
  const Outcome outcome = run_feldspar(folder, "lab rock/input.prm --output rock");
  EXPECT_TRUE(has_words(outcome.error, "rock: is not empty; choose another folder with --output"));
  EXPECT_EQ(outcome.error.find("--force"), std::string::npos) << outcome.error;
}

TEST(WriteOver, IsRefusedWhereAFileThatIsReadLiesAmongTheResults)
{
  const TemporaryFolder folder;
  for (const char* const below : {"out", "out/tables", "out/curves"})
    fs::create_directory(folder / below);
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
  expect("lab", section("Report", "Reference file = out/reference.json"), "out/reference.json");
  expect("lab", section("Specimen", "Specimen file = out/specimen.h5"), "out/specimen.h5");
  expect("lab", section("Specimen", "Packing file = out/curves/packing.txt"), "out/curves/packing.txt");
  expect("lab", section("Flaws", "Traces file = out/tables/traces.csv"), "out/tables/traces.csv");
  expect("specimen", section("Specimen", "Specimen file = out/specimen.h5"), "out/specimen.h5");
  expect("contact", section("Contact path", "File = out/contact.csv"), "out/contact.csv");
  expect_refused(folder, "report --curve out/tables/core.csv --output out --force", "out/tables/core.csv is read");
}

TEST(WriteOver, IsRefusedWhereNoRunIsKnownToHaveWrittenAFile)
{
  const TemporaryFolder folder;
  fs::create_directory(folder / "out");
  folder.write("a.prm", rock + section("Contact path", "File = path.csv"));
  folder.write("path.csv", path_table);
  for (const auto& [name, command] : {std::pair("input.prm", "lab"),
                                      {"reference.json", "lab"},
                                      {"specimen.h5", "specimen"},
                                      {"contact.csv", "contact"}})
    {
      folder.write(fmt::format("out/{}", name), "mine");
      expect_refused(folder, fmt::format("{} a.prm --output out --force", command),
                     fmt::format("no run is known to have written out/{}", name));
      fs::remove(folder / "out" / name);
    }
}

TEST(WriteOver, TakesOutWhatRunsWroteAndNothingElse)
{
  const TemporaryFolder folder;
  folder.write("a.prm", rock + section("Report", "Reference file = reference.json"));
  folder.write("b.prm", rock + section("Seeds", "Seeds = 2"));
  folder.write("reference.json", reference);
  run_to_end(folder, "lab a.prm --output out --quiet", with_pictures);
  const fs::path out = folder / "out";
  // Every file of a run is on its list.
  const std::set<std::string> listed = lines_of(out / ".feldspar-files");
  for (const auto& [file, bytes] : all_files(out))
    EXPECT_TRUE(listed.contains(file)) << file;

  const std::vector<std::string> mine{"notes.txt",       "figures/mine.png", "tables/mine.csv",    "curves/mine.csv",
                                      "grains/mine.csv", "fields/mine.vtp",  "checkpoints/mine.h5"};
  fs::create_directory(out / "checkpoints");
  for (const std::string& file : mine)
    folder.write("out/" + file, file);
  // The list may be another's: nothing out of the folder, and nothing through a link.
  folder.write("victim.csv", "precious");
  fs::create_directory(folder / "elsewhere");
  folder.write("elsewhere/victim.csv", "precious");
  fs::create_symlink("../elsewhere", out / "linked");
  std::ofstream(out / ".feldspar-files", std::ios::app)
    << "../victim.csv\ntables/../../victim.csv\n"
    << (folder / "victim.csv").string() << "\nlinked/victim.csv\nnotes.txt\ntables\n";

  run_to_end(folder, "lab b.prm --output out --force --quiet");
  EXPECT_FALSE(fs::exists(out / "curves/direct_tension_seed_1.csv"));
  EXPECT_FALSE(fs::exists(out / "reference.json")) << "of the run before";
  for (const std::string& file : mine)
    EXPECT_EQ(content(out / file), file);
  EXPECT_EQ(content(folder / "victim.csv"), "precious");
  EXPECT_EQ(content(folder / "elsewhere/victim.csv"), "precious");

  // A report leaves the user's files alone too.
  run_to_end(folder, "report out --quiet");
  for (const std::string& file : mine)
    EXPECT_EQ(content(out / file), file);
}

// A name of a result in a folder of results, which no run wrote: before any run, beside an earlier run, as a folder.
TEST(WriteOver, KeepsAFileOfTheUserInThePlaceOfAResultAside)
{
  const TemporaryFolder folder;
  folder.write("a.prm", rock);
  for (const char* const below : {"out", "out/tables", "out/curves"})
    fs::create_directory(folder / below);
  folder.write("out/tables/tests.csv", "mine");
  folder.write("out/curves/direct_tension_seed_1.csv", "mine too");
  const auto first = run_to_end(folder, "lab a.prm --output out --force --quiet");
  EXPECT_EQ(content(folder / "out/tables/tests.csv.kept"), "mine");
  EXPECT_EQ(content(folder / "out/curves/direct_tension_seed_1.csv.kept"), "mine too");
  EXPECT_TRUE(has_words(first.error, "direct_tension_seed_1.csv: no run is known to have written it; it is kept as "
                                     "direct_tension_seed_1.csv.kept\n"));

  folder.write("out/curves/direct_tension_seed_2.csv", "of my second core");
  fs::create_directory(folder / "out/curves/direct_tension_seed_3.csv");
  folder.write("out/curves/direct_tension_seed_3.csv/notes.txt", "a folder of mine");
  run_to_end(folder, "lab a.prm --set \"Seeds/Seeds = 2..3\" --output out --force --quiet");
  EXPECT_EQ(content(folder / "out/curves/direct_tension_seed_2.csv.kept"), "of my second core");
  EXPECT_EQ(content(folder / "out/curves/direct_tension_seed_3.csv.kept/notes.txt"), "a folder of mine");
  EXPECT_EQ(content(folder / "out/tables/tests.csv.kept"), "mine");

  // A report beside the results asks for no --force, and loses nothing either.
  fs::remove(folder / "out/report.html");
  fs::create_directory(folder / "out/report.html");
  std::ofstream(folder / "out/.feldspar-files") << "run.json\nsummary.json\n";
  run_to_end(folder, "report out --quiet");
  EXPECT_TRUE(fs::is_directory(folder / "out/report.html.kept"));
  EXPECT_TRUE(fs::exists(folder / "out/tables/tests.csv.kept-2"));
}

// All files are read before anything is taken out; a slot that takes the upper end off is found once the rock is made.
TEST(WriteOver, ThatIsRefusedLaterLeavesTheEarlierRunAsItWas)
{
  const TemporaryFolder folder;
  folder.write("a.prm", rock);
  run_to_end(folder, "lab a.prm --output out --quiet");
  folder.write("out/tables/mine.csv", "mine");
  folder.write("broken.h5", "no specimen");
  folder.write("packing.txt", "0.002 0.002 nothing\n");
  const auto before = all_files(folder);
  const auto listed = lines_of(folder / "out/.feldspar-files");
  for (const auto& [setting, words] : {std::pair("Specimen/Specimen file = broken.h5", "broken.h5: "),
                                       {"Specimen/Packing file = packing.txt", "packing.txt:1: "},
                                       {"Flaws/Shapes = slot from 0, 6 mm to 8, 6 mm width 1.5 mm", ""},
                                       {"Tests/Grip ratio = 0.001", ""}})
    {
      expect_mistake(folder, fmt::format("lab a.prm --set \"{}\" --output out --force --quiet", setting), words);
      EXPECT_TRUE(all_files(folder) == before) << setting;
      EXPECT_EQ(lines_of(folder / "out/.feldspar-files"), listed);
    }
}

TEST(WriteOver, NamesAnObstacleByItsOwnName)
{
  const TemporaryFolder folder;
  folder.write("a.prm", rock);
  run_to_end(folder, "lab a.prm --output out --quiet");
  fs::rename(folder / "out/tables", folder / "tables");
  folder.write("out/tables", "a file");
  for (const char* const command : {"report out", "lab a.prm --output out --force"})
    expect_refused(folder, command, "out/tables: is a file, where a folder of results is to be; move it elsewhere");
  fs::remove(folder / "out/tables");
  folder.write("victim", "precious");
  fs::rename(folder / "out/.feldspar-files", folder / "list");
  fs::create_symlink("../victim", folder / "out/.feldspar-files");
  expect_refused(folder, "report out", "out/.feldspar-files: is a link");
  // A name that no run of this rock writes is no obstacle.
  fs::create_directory(folder / "mine");
  folder.write("mine/specimen_notes.h5", "notes");
  run_to_end(folder, "specimen a.prm --output mine --force --quiet");
  EXPECT_EQ(content(folder / "mine/specimen_notes.h5"), "notes");
}

TEST(WriteOver, OfAVersionWithoutListsTakesOutTheKnownNamesAtTheTop)
{
  const TemporaryFolder folder;
  folder.write("a.prm", rock);
  run_to_end(folder, "lab a.prm --output out --quiet");
  const fs::path out = folder / "out";
  fs::remove(out / ".feldspar-files");
  folder.write("out/figures/mine.png", "mine");
  folder.write("out/specimen_seed_7.h5", "of the earlier run");
  const Outcome offered = run_feldspar(folder, "lab a.prm --output out");
  EXPECT_TRUE(has_words(offered.error, "(--force replaces the run in it, and keeps all other files)"));
  run_to_end(folder, "lab a.prm --output out --force --quiet");
  EXPECT_EQ(content(out / "figures/mine.png"), "mine");
  EXPECT_FALSE(fs::exists(out / "specimen_seed_7.h5"));
  // A report there makes a list, with what the older run wrote.
  fs::remove(out / ".feldspar-files");
  run_to_end(folder, "report out --quiet");
  EXPECT_TRUE(lines_of(out / ".feldspar-files").contains("run.json"));
  run_to_end(folder, "lab a.prm --output out --force --quiet");
}

/// A run whose record says that something is left to be done.
void make_incomplete(const fs::path& folder)
{
  const std::string record = replaced(content(folder / "run.json"), "\"complete\": true", "\"complete\": false");
  std::ofstream(folder / "run.json") << record;
}

TEST(Resume, RefusesAnInputThatIsNotThatOfItsRun)
{
  const TemporaryFolder folder;
  folder.write("a.prm", rock + section("Report", "Reference file = reference.json"));
  folder.write("reference.json", reference);
  run_to_end(folder, "lab a.prm --output out --quiet");
  make_incomplete(folder / "out");
  const std::string input = content(folder / "out/input.prm");
  for (const std::string& changed : {std::string(), input + "\n"})
    {
      folder.write("out/input.prm", changed);
      expect_refused(folder, "lab --resume out", "out: out/input.prm is not as it was when the run began");
    }
  folder.write("out/input.prm", input);
  folder.write("reference.json", R"({"experiment": {"tensile_strength_MPa": 8}})");
  expect_refused(folder, "lab --resume out", "reference.json is not as it was when the run began");
  fs::remove(folder / "reference.json");
  expect_refused(folder, "lab --resume out", "reference.json: cannot be read: No such file");
  folder.write("reference.json", reference);
  run_to_end(folder, "lab --resume out --quiet");
}

// The folder keeps the input of its run; who edits his own file is told that it is not read.
TEST(Resume, SaysThatAnInputThatHasChangedIsNotRead)
{
  const TemporaryFolder folder;
  folder.write("a.prm", rock);
  run_to_end(folder, "lab a.prm --output out --quiet");
  const std::string curve = content(folder / "out/curves/direct_tension_seed_1.csv");
  EXPECT_EQ(run_feldspar(folder, "lab --resume out").error, "");
  folder.write("a.prm", rock + section("Seeds", "Seeds = 2"));
  const std::string remark =
    fmt::format("feldspar: {}: has changed since the run began, and is not read; the run goes by out/input.prm\n",
                (fs::canonical(folder.path()) / "a.prm").string());
  EXPECT_EQ(run_without_pictures(folder, "lab --resume out --quiet").error, remark); // of a run that is complete
  make_incomplete(folder / "out");
  EXPECT_EQ(run_to_end(folder, "lab --resume out --quiet").error, remark);
  EXPECT_EQ(content(folder / "out/curves/direct_tension_seed_1.csv"), curve);
  fs::remove(folder / "a.prm");
  EXPECT_EQ(run_without_pictures(folder, "lab --resume out --quiet").error, "");
}

TEST(Links, LeadNoWriterOutOfTheFolder)
{
  const TemporaryFolder folder;
  folder.write("a.prm", rock);
  run_to_end(folder, "lab a.prm --output out --quiet", with_pictures);
  folder.write("victim.txt", "precious");
  fs::create_directory(folder / "outside");
  folder.write("outside/kept.csv", "precious");
  const fs::path out = folder / "out";
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
  run_to_end(folder, "report out --quiet", with_pictures);
  EXPECT_EQ(content(folder / "victim.txt"), "precious");
  for (const char* const file : {"report.html", "figures/direct_tension_seed_1_cracks.png",
                                 "figures/direct_tension_stress.svg", "tables/strengths.csv"})
    EXPECT_TRUE(fs::is_regular_file(fs::symlink_status(out / file))) << file;

  // A resumed run writes tables, fields and its record.
  make_incomplete(out);
  for (const char* const file : {"summary.json", "log.txt", "tests.csv", "run.json.unfinished"})
    link("../victim.txt", file);
  for (const char* const file : {"curves/direct_tension_seed_1.csv", "fields/direct_tension_seed_1_grains.pvd"})
    link("../../victim.txt", file);
  run_to_end(folder, "lab --resume out --quiet");
  EXPECT_EQ(content(folder / "victim.txt"), "precious");

  // Links in the place of folders are refused, wherever they lie; a list that is a link, too.
  make_incomplete(out);
  for (const char* const name : {"tables", "figures", "fields/direct_tension_seed_1", "curves"})
    {
      fs::rename(out / name, folder / "aside");
      fs::create_directory_symlink(folder / "outside", out / name);
      for (const char* const command : {"report out", "lab --resume out", "lab a.prm --output out --force"})
        expect_refused(folder, command, fmt::format("out/{}: is a link to another folder", name));
      fs::remove(out / name);
      fs::rename(folder / "aside", out / name);
    }
  EXPECT_EQ(content(folder / "outside/kept.csv"), "precious");
  EXPECT_EQ(all_files(folder / "outside").size(), 1u);
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
  run_to_end(folder, "lab run.prm --output out --quiet");
  make_incomplete(folder / "out");
  const std::vector<Reader> readers{{"lab in.prm", "", "in.prm"},
                                    {"lab in.json", "", "in.json"},
                                    {"parameters --check in.prm", "", "in.prm"},
                                    {"contact a.prm", section("Contact path", "File = path.csv"), "path.csv"},
                                    {"lab a.prm", rock + section("Report", "Reference file = r.json"), "r.json"},
                                    {"lab a.prm", rock + section("Report", "Reference results = s.json"), "s.json"},
                                    {"lab a.prm", rock + section("Specimen", "Packing file = p.txt"), "p.txt"},
                                    {"specimen a.prm", rock + section("Specimen", "Specimen file = b.h5"), "b.h5"},
                                    {"lab a.prm", rock + section("Flaws", "Traces file = t.csv"), "t.csv"},
                                    {"lab a.prm", rock + section("Flaws", "Traces file = t.dxf"), "t.dxf"},
                                    {"lab a.prm", section("Tests", "Loading table = stages.csv"), "stages.csv"},
                                    {"lab a.prm", rock + section("Variants", "Table = v.csv"), "v.csv"},
                                    {"rve a.prm", section("Strain path", "File = strain.csv"), "strain.csv"},
                                    {"multiscale a.prm", section("Sample", "Mesh file = m.msh"), "m.msh"},
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
        const fs::path file = folder / reader.file;
        const bool was_there = fs::exists(file);
        if (was_there)
          fs::rename(file, folder / "aside");
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
          fs::rename(folder / "aside", file);
      }
  // A table that is missing costs its curve alone, and so does a pipe in its place.
  fs::remove(folder / "out/curves/direct_tension_seed_1.csv");
  ASSERT_EQ(mkfifo((folder / "out/curves/direct_tension_seed_1.csv").c_str(), 0600), 0);
  const auto report = run_to_end(folder, "report out", "timeout 20");
  EXPECT_TRUE(has_words(report.output, "direct_tension_seed_1.csv: is a pipe; "));
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
        const Outcome outcome = run_feldspar(folder, arguments);
        EXPECT_TRUE(outcome.exit_code == 2 || outcome.exit_code == 3) << arguments << outcome.exit_code;
        EXPECT_EQ(n_lines(outcome.error), 1u) << arguments << outcome.error;
        EXPECT_FALSE(has_control(outcome.error)) << arguments;
        // "feldspar: ", 2000 characters and the line's end; an ellipsis takes three bytes.
        EXPECT_LE(outcome.error.size(), 2015u) << arguments;
      }
  const Outcome unknown = run_feldspar(folder, "lab a.prm --" + longest);
  EXPECT_LT(unknown.error.size(), 800u);
  EXPECT_TRUE(has_words(unknown.error, "; see feldspar lab --help"));
}

TEST(Report, SaysInOneLineThatManyTestsAreMissing)
{
  const TemporaryFolder folder;
  folder.write("a.prm", rock);
  run_to_end(folder, "lab a.prm --output out --quiet");
  auto summary = nlohmann::ordered_json::parse(content(folder / "out/summary.json"));
  const auto test = summary["tests"][0];
  constexpr std::size_t n = 1000;
  for (std::size_t k = 2; k <= n; ++k)
    {
      summary["tests"].push_back(test);
      summary["tests"].back()["name"] = fmt::format("direct_tension_seed_{}", k);
      summary["tests"].back()["seed"] = k;
    }
  folder.write("out/summary.json", summary.dump());
  expect_refused(folder, "report out --reference none.json", "");
  const auto many = run_to_end(folder, "report out", with_pictures);
  const std::string missing = "cannot be read: No such file";
  EXPECT_TRUE(has_words(many.output, fmt::format("{} or directory (and {} more like it)", missing, 2 * (n - 1) - 1)));
  EXPECT_EQ(many.output.find(missing), many.output.rfind(missing));
  EXPECT_LE(n_lines(many.output), 4u) << many.output.substr(0, 4000);
}

TEST(EqualRuns, HaveEqualFilesOfHdf5)
{
  const TemporaryFolder folder;
  folder.write("a.prm", rock);
  folder.write("b.prm", section("Sample", "Material = linear elasticity", "Width = 12 mm", "Height = 24 mm",
                                "Elements across = 1", "Elements along = 2") +
                          section("Tests", "List = uniaxial_compression", "Stop strain = 1e-4"));
  for (const char* const which : {"1", "2"})
    {
      run_to_end(folder, fmt::format("specimen a.prm --output grains{} --quiet", which));
      run_to_end(folder, fmt::format("multiscale b.prm --output sample{} --quiet", which));
      if (which == std::string("1"))
        std::this_thread::sleep_for(std::chrono::milliseconds(1100)); // times in such files have seconds
    }
  std::size_t n = 0;
  for (const char* const of : {"grains", "sample"})
    for (const auto& [file, bytes] : all_files(folder / (of + std::string("1"))))
      if (file.ends_with(".h5") &&
          !file.starts_with("states/")) // a state has its computing time, for the run that goes on
        {
          ++n;
          EXPECT_TRUE(content(folder / (of + std::string("2")) / file) == bytes) << file;
        }
  EXPECT_GE(n, 3u);
}
} // namespace
} // namespace feldspar::tests

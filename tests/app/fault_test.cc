#include "base/random.h"
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
#include <iterator>
#include <regex>
#include <string>
#include <vector>

/// Faults of the surroundings: disks, folders, streams, signals, other programs.
namespace feldspar::tests
{
namespace
{
namespace fs = std::filesystem;

/// Over in half a second: a test that stops before its peak.
const std::string quick_rock = R"(subsection Specimen
  set Width = 8 mm
  set Height = 12 mm
end
subsection Tests
  set List = direct_tension
  set Stop strain = 2e-5
end
)";

/// The same with a row that takes hours.
std::string slow_rock()
{
  return quick_rock.substr(0, quick_rock.find("  set Stop")) + "  set Tension strain rate = 1e-8 1/s\nend\n";
}

/// A script that ends a command once it makes its tests. What a command said before it must not be taken for that.
const std::string interrupt_in_tests =
  "rm -f said\n\"$@\" 2>said &\nuntil grep -sq tests said; do sleep 0.02; done\nkill -TERM $!\nwait $!\n";

/// A command of each kind, of seconds at most; `report` is of the folder "whole".
struct CommandOfEachKind
{
  std::string arguments; ///< without --output
  std::string input;
};

const std::vector<CommandOfEachKind>& commands_of_each_kind()
{
  static const std::string rock = quick_rock;
  static const std::string cell =
    "subsection Specimen\n  set Shape = periodic\n  set Width = 12 mm\n  set Height = 12 mm\nend\n";
  static const std::vector<CommandOfEachKind> all{
    {"lab rock.prm", rock},
    {"specimen rock.prm", rock},
    {"contact contact.prm", "subsection Contact path\n  set File = path.csv\nend\n"},
    {"rve cell.prm", cell + "subsection Strain path\n  set Direction = 1, 0, 0\n  set Size = 2e-5\nend\n"},
    {"multiscale sample.prm", "subsection Sample\n  set Material = linear elasticity\nend\nsubsection Tests\n"
                              "  set List = direct_tension\n  set Stop strain = 1e-5\nend\n"},
    {"calibrate calibrate.prm", rock + "subsection Report\n  set Reference file = rock.json\nend\n"},
    {"report whole", ""}};
  return all;
}

void write_inputs(const TemporaryFolder& folder)
{
  for (const auto& [arguments, input] : commands_of_each_kind())
    if (!input.empty())
      folder.write(arguments.substr(arguments.find(' ') + 1), input);
  folder.write("path.csv", "normal_m,shear_m,rotation_rad\n-1e-6,0,0\n");
  folder.write("rock.json",
               R"({"rock": "granite", "experiment": {"tensile_strength_MPa": 9, "youngs_modulus_GPa": 60}})");
}

std::size_t n_lines(const std::string& text) { return std::size_t(std::count(text.begin(), text.end(), '\n')); }

void expect_nothing_half_written(const fs::path& folder)
{
  for (const auto& entry : fs::recursive_directory_iterator(folder))
    EXPECT_NE(entry.path().extension(), ".unfinished") << entry.path();
}

// Whatever write it is that meets the full disk: one line, code 3, nothing half written, and the run goes on once there
// is room.
TEST(Fault, ADiskThatIsFullAtAnyWriteIsSaidInOneLine)
{
  const TemporaryFolder folder;
  folder.write("rock.prm", quick_rock);
  ASSERT_EQ(run_without_pictures(folder.path(), "lab rock.prm --output whole --quiet").exit_code, 0);
  int n_met = 0;
  for (const int n_writes : {0, 1, 2, 12, 40, 200, 400}) // of some 450, most of them of checkpoints
    {
      const std::string out = fmt::format("out-{}", n_writes);
      const auto outcome =
        run_feldspar(folder.path(), "lab rock.prm --output " + out + " --quiet",
                     fmt::format("LD_PRELOAD='{}' FELDSPAR_WRITES_LEFT={}", FELDSPAR_FULL_DISK, n_writes));
      EXPECT_EQ(outcome.exit_code, 3) << n_writes;
      EXPECT_EQ(n_lines(outcome.error), 1u) << outcome.error;
      EXPECT_NE(outcome.error.find("No space left on device"), std::string::npos) << outcome.error;
      if (!fs::exists(folder.path() / out))
        continue; // not even begun
      expect_nothing_half_written(folder.path() / out);
      ++n_met;
      if (n_writes == 12 || n_writes == 400)
        {
          EXPECT_EQ(run_without_pictures(folder.path(), "lab --resume " + out + " --quiet").exit_code, 0) << n_writes;
          EXPECT_EQ(content(folder.path() / out / "curves/direct_tension_seed_1.csv"),
                    content(folder.path() / "whole/curves/direct_tension_seed_1.csv"));
        }
    }
  EXPECT_GE(n_met, 4);
}

TEST(Fault, AFullDiskIsSaidInOneLineByEachCommand)
{
  const TemporaryFolder folder;
  write_inputs(folder);
  ASSERT_EQ(run_without_pictures(folder.path(), "lab rock.prm --output whole --quiet").exit_code, 0);
  for (const auto& [arguments, input] : commands_of_each_kind())
    for (const int n_writes : {0, 3})
      {
        if (n_writes > 0 && (arguments.starts_with("specimen") || arguments.starts_with("contact") ||
                             arguments.starts_with("calibrate")))
          continue; // two write no more, and the third makes many specimens before it does
        const auto outcome =
          run_feldspar(folder.path(), fmt::format("{} --output out --force --quiet", arguments),
                       fmt::format("LD_PRELOAD='{}' FELDSPAR_WRITES_LEFT={}", FELDSPAR_FULL_DISK, n_writes));
        EXPECT_EQ(outcome.exit_code, 3) << arguments;
        EXPECT_EQ(n_lines(outcome.error), 1u) << arguments << ": " << outcome.error;
        EXPECT_NE(outcome.error.find("No space left on device"), std::string::npos) << arguments << outcome.error;
        if (fs::exists(folder.path() / "out"))
          expect_nothing_half_written(folder.path() / "out");
        fs::remove_all(folder.path() / "out");
      }
}

// From the beginning, or from some change on, as a file system does that met an error of its disk.
TEST(Fault, AFileSystemThatIsReadOnlyIsSaidInOneLineByEachCommand)
{
  const TemporaryFolder folder;
  write_inputs(folder);
  ASSERT_EQ(run_feldspar(folder.path(), "lab rock.prm --output whole --quiet").exit_code, 0);
  const std::string page = content(folder.path() / "whole/report.html");
  for (const auto& [arguments, input] : commands_of_each_kind())
    for (const int n_changes : {0, 2, 5})
      {
        // The first change is the folder itself, a mistake in the choice of which is the user's.
        if (n_changes > 2 && (arguments.starts_with("specimen") || arguments.starts_with("contact") ||
                              arguments.starts_with("calibrate")))
          continue; // two change no more, and the third makes many specimens before it does
        const auto outcome =
          run_feldspar(folder.path(), arguments + " --output out --quiet",
                       fmt::format("LD_PRELOAD='{}' FELDSPAR_CHANGES_LEFT={}", FELDSPAR_READ_ONLY, n_changes));
        EXPECT_EQ(outcome.exit_code, n_changes == 0 ? 2 : 3) << arguments << ", " << n_changes;
        EXPECT_EQ(n_lines(outcome.error), 1u) << arguments << ", " << n_changes << ": " << outcome.error;
        EXPECT_NE(outcome.error.find("Read-only file system"), std::string::npos) << arguments << outcome.error;
        if (n_changes == 0)
          {
            EXPECT_FALSE(fs::exists(folder.path() / "out")) << arguments;
          }
        fs::remove_all(folder.path() / "out");
      }
  // A report into the folder of its results.
  const auto outcome =
    run_feldspar(folder.path(), "report whole --quiet", fmt::format("LD_PRELOAD='{}'", FELDSPAR_READ_ONLY));
  EXPECT_EQ(outcome.exit_code, 3);
  EXPECT_EQ(n_lines(outcome.error), 1u) << outcome.error;
  EXPECT_EQ(content(folder.path() / "whole/report.html"), page);
}

// The folder may come back: nothing is lost.
TEST(Fault, AFolderThatIsMovedDuringTheRunIsSaidInOneLineAndTakenUpWhereItIs)
{
  const TemporaryFolder folder;
  folder.write("rock.prm", slow_rock());
  folder.write("move", "\"$@\" &\nuntil [ -e out/specimen.h5 ]; do sleep 0.02; done\nsleep 0.2\nmv out moved\n"
                       "kill -TERM $!\nwait $!\n");
  const auto outcome = run_feldspar(folder.path(), "lab rock.prm --output out --quiet", "timeout 60 sh ./move");
  EXPECT_EQ(outcome.exit_code, 3);
  EXPECT_EQ(n_lines(outcome.error), 1u) << outcome.error;
  EXPECT_NE(outcome.error.find("No such file or directory"), std::string::npos) << outcome.error;
  EXPECT_FALSE(fs::exists(folder.path() / "out"));
  folder.write("end", interrupt_in_tests);
  const std::string specimen = content(folder.path() / "moved/specimen.h5");
  EXPECT_EQ(run_feldspar(folder.path(), "lab --resume moved", "timeout 60 sh ./end").exit_code, 130);
  EXPECT_EQ(content(folder.path() / "moved/specimen.h5"), specimen);
}

// Another width, or the same packing with another density.
TEST(Fault, AnotherSpecimenInTheFolderIsNotTakenForThatOfTheRun)
{
  const TemporaryFolder folder;
  folder.write("rock.prm", slow_rock());
  folder.write("end", interrupt_in_tests);
  EXPECT_EQ(run_feldspar(folder.path(), "lab rock.prm --output out", "timeout 60 sh ./end").exit_code, 130);
  const std::string own = content(folder.path() / "out/specimen.h5");
  for (const std::string change : {"Specimen/Width = 12 mm", "Specimen/Density = 1350 kg/m^3"})
    {
      SCOPED_TRACE(change);
      ASSERT_EQ(run_feldspar(folder.path(), "specimen rock.prm --output other --force --quiet --set '" + change + "'")
                  .exit_code,
                0);
      fs::copy_file(folder.path() / "other/specimen.h5", folder.path() / "out/specimen.h5",
                    fs::copy_options::overwrite_existing);
      EXPECT_EQ(run_feldspar(folder.path(), "lab --resume out", "timeout 60 sh ./end").exit_code, 130);
      const std::string said = content(folder.path() / "said");
      EXPECT_NE(said.find("specimen.h5: not the specimen of this run; making it anew"), std::string::npos) << said;
      EXPECT_EQ(said.find("going back"), std::string::npos) << said;
      EXPECT_EQ(content(folder.path() / "out/specimen.h5"), own);
    }
}

TEST(Fault, AClockThatGoesBackChangesNothing)
{
  const TemporaryFolder folder;
  folder.write("rock.prm", quick_rock);
  ASSERT_EQ(run_without_pictures(folder.path(), "lab rock.prm --output whole --quiet").exit_code, 0);
  const std::string going_back = fmt::format("LD_PRELOAD='{}'", FELDSPAR_CLOCK_GOING_BACK);
  // A clock that goes as ever would pass all below.
  const auto now = run_command(folder.path(), "date +%s");
  const auto set_back = run_command(folder.path(), going_back + " date +%s");
  EXPECT_LT(std::stol(set_back.output), std::stol(now.output) - 3000);
  const auto outcome = run_feldspar(folder.path(), "lab rock.prm --output out --quiet", going_back);
  EXPECT_EQ(outcome.exit_code, 0);
  EXPECT_EQ(outcome.error, "");
  for (const char* file : {"curves/direct_tension_seed_1.csv", "cracks.csv"}) // HDF5 keeps the time of the day
    EXPECT_EQ(content(folder.path() / "out" / file), content(folder.path() / "whole" / file)) << file;
  const auto summary = nlohmann::json::parse(content(folder.path() / "out/summary.json"));
  const double seconds = summary["tests"][0]["wall_time_s"].get<double>();
  EXPECT_GE(seconds, 0.0);
  EXPECT_LT(seconds, 60.0);
}

TEST(Fault, AFolderThatGoesDuringTheRunIsSaidInOneLine)
{
  const TemporaryFolder folder;
  folder.write("rock.prm", slow_rock());
  folder.write("remove", "\"$@\" &\nuntil [ -e out/specimen.h5 ]; do sleep 0.02; done\nsleep 0.2\nrm -r out\n"
                         "kill -TERM $!\nwait $!\n");
  const auto outcome = run_feldspar(folder.path(), "lab rock.prm --output out --quiet", "timeout 10 sh ./remove");
  EXPECT_EQ(outcome.exit_code, 3);
  EXPECT_EQ(n_lines(outcome.error), 1u) << outcome.error;
  EXPECT_NE(outcome.error.find("No such file or directory"), std::string::npos) << outcome.error;
}

TEST(Fault, AStandardOutputThatIsClosedFullOrLeftDoesNotCostTheRun)
{
  const TemporaryFolder folder;
  folder.write("rock.prm", quick_rock);
  ASSERT_EQ(run_without_pictures(folder.path(), "lab rock.prm --output whole --quiet").exit_code, 0);
  const auto same = [&](const std::string& out) {
    for (const char* file : {"curves/direct_tension_seed_1.csv", "cracks.csv"})
      EXPECT_EQ(content(folder.path() / out / file), content(folder.path() / "whole" / file)) << out << "/" << file;
    EXPECT_TRUE(nlohmann::json::accept(content(folder.path() / out / "summary.json"))) << out;
    EXPECT_TRUE(nlohmann::json::parse(content(folder.path() / out / "run.json"))["complete"].get<bool>()) << out;
  };
  // Closed: its number must not go to the first file that is opened.
  EXPECT_EQ(run_feldspar(folder.path(), "lab rock.prm --output closed >&- 2>&- <&-").exit_code, 0);
  same("closed");
  const auto full = run_without_pictures(folder.path(), "lab rock.prm --output full --quiet > /dev/full");
  EXPECT_EQ(full.exit_code, 3);
  EXPECT_EQ(n_lines(full.error), 1u) << full.error;
  EXPECT_NE(full.error.find("standard output"), std::string::npos) << full.error;
  same("full");
  // Who reads along goes away, also from the progress.
  run_feldspar(folder.path(), "lab rock.prm --output left 2>&1 | head -c 1");
  same("left");
  folder.write("sample.prm",
               "subsection Specimen\n  set Shape = periodic\n  set Width = 10 mm\n  set Height = 10 mm\nend\n"
               "subsection Sample\n  set Width = 10 mm\n  set Height = 10 mm\n"
               "  set Elements across = 1\n  set Elements along = 1\n  set Realisations = 1\nend\n"
               "subsection Tests\n  set List = direct_tension\n  set Stop strain = 5e-5\nend\n");
  run_feldspar(folder.path(), "multiscale sample.prm --output sample 2>&1 | head -c 1");
  EXPECT_TRUE(nlohmann::json::accept(content(folder.path() / "sample/summary.json")));
  const auto parameters = run_feldspar(folder.path(), "parameters > /dev/full");
  EXPECT_EQ(parameters.exit_code, 3);
  EXPECT_EQ(n_lines(parameters.error), 1u) << parameters.error;
}

TEST(Fault, OneFolderTakesOneRunAtATime)
{
  const TemporaryFolder folder;
  folder.write("rock.prm", slow_rock());
  const std::string feldspar = std::string("'") + FELDSPAR_COMMAND + "'";
  folder.write("two", "\"$@\" &\nuntil [ -e out/specimen.h5 ]; do sleep 0.02; done\n" + feldspar +
                        " lab --resume out --quiet; echo $?\n" + feldspar +
                        " lab rock.prm --output out --force --quiet; echo $?\n" + feldspar +
                        " specimen rock.prm --output out --force --quiet; echo $?\n" + feldspar +
                        " report out --quiet; echo $?\nkill -TERM $!\nwait $!\n");
  const auto outcome = run_feldspar(folder.path(), "lab rock.prm --output out --quiet", "timeout 60 sh ./two");
  EXPECT_EQ(outcome.exit_code, 130);
  EXPECT_EQ(outcome.output, "2\n2\n2\n2\nout\n");
  const std::string refusal = "feldspar: out: another feldspar works in this folder; ";
  EXPECT_EQ(outcome.error.find(refusal), 0u) << outcome.error;
  std::size_t n_refusals = 0;
  for (std::size_t at = 0; (at = outcome.error.find(refusal, at)) != std::string::npos; ++at)
    ++n_refusals;
  EXPECT_EQ(n_refusals, 4u) << outcome.error;
  EXPECT_TRUE(fs::exists(folder.path() / "out/run.json"));
}

// Names of folders come from others, and a terminal obeys escape characters.
TEST(Output, OfAFolderWhoseNameHasControlCharactersIsPrintable)
{
  const TemporaryFolder folder;
  write_inputs(folder);
  ASSERT_EQ(run_without_pictures(folder.path(), "lab rock.prm --output whole --quiet").exit_code, 0);
  for (const auto& [arguments, input] : commands_of_each_kind())
    {
      const std::string command = arguments.substr(0, arguments.find(' '));
      if (command == "calibrate")
        continue; // takes the longest, and ends as lab does
      SCOPED_TRACE(command);
      const Outcome outcome =
        run_feldspar(folder.path(), arguments + " --output \"$(printf '" + command + "\\033[31m')\"");
      EXPECT_EQ(outcome.exit_code, 0) << outcome.error;
      EXPECT_EQ((outcome.output + outcome.error).find('\x1b'), std::string::npos);
      EXPECT_NE(outcome.output.find(command + "\\x1b[31m"), std::string::npos) << outcome.output;
    }
}

// A test that runs to 1.6 times the strain at its peak, as most do: steps within a factor of two.
TEST(Load, StepsMemoryAndTimeOfTestsAreSaidBeforehand)
{
  const TemporaryFolder folder;
  folder.write("rock.prm", quick_rock.substr(0, quick_rock.find("  set Stop")) + "end\n");
  const auto outcome = run_feldspar(folder.path(), "lab rock.prm --output out");
  ASSERT_EQ(outcome.exit_code, 0) << outcome.error;
  static const std::regex words(
    R"(1 test of some (\d+) steps: about (\d+) MB with specimens and program, (\d+) s\s+with\s+pictures)");
  std::smatch said;
  ASSERT_TRUE(std::regex_search(outcome.error, said, words)) << outcome.error;
  const auto summary = nlohmann::json::parse(content(folder.path() / "out/summary.json"));
  const double steps = summary["tests"][0]["steps"].get<double>();
  EXPECT_GT(std::stod(said[1]), 0.5 * steps);
  EXPECT_LT(std::stod(said[1]), 2.0 * steps);
  EXPECT_LT(std::stod(said[2]), 200.0); // so small a rock: the program alone has some 40
}

// 1 000 variants of 100 000 grains each would leave records of more than a hundred gigabytes.
TEST(Load, TestsThatDoNotFitAreRefusedBeforeAnyWork)
{
  const TemporaryFolder folder;
  std::string values = "1e-3";
  for (int k = 1; k < 1000; ++k)
    values += fmt::format("; {}e-6", 1000 + k);
  folder.write("rock.prm", "subsection Specimen\n  set Width = 360 mm\n  set Height = 720 mm\nend\n"
                           "subsection Variants\n  set Entry = Tests/Stop strain\n  set Values = " +
                             values + "\nend\n");
  const auto outcome = run_feldspar(folder.path(), "lab rock.prm --output out");
  EXPECT_EQ(outcome.exit_code, 2);
  EXPECT_EQ(n_lines(outcome.error), 1u) << outcome.error.substr(0, 1000);
  EXPECT_NE(outcome.error.find("Tests: 2000 test(s) of 1 specimen(s)"), std::string::npos)
    << outcome.error.substr(0, 1000);
  EXPECT_FALSE(fs::exists(folder.path() / "out"));
}

// The rate of the test is 1e-24 of the usual one, which takes a hundred thousand steps.
TEST(Load, TestsThatWouldNotEndAreRefused)
{
  const TemporaryFolder folder;
  folder.write("rock.prm", quick_rock);
  const auto outcome = run_without_pictures(
    folder.path(), "lab rock.prm --output out --quiet --set 'Tests/Tension strain rate = 1e-25 1/s'");
  EXPECT_EQ(outcome.exit_code, 2);
  EXPECT_NE(outcome.error.find("steps; a strain rate is far too low"), std::string::npos) << outcome.error;
}

TEST(Fault, NeedsNoHomeAndNoFolderForTemporaryFiles)
{
  const TemporaryFolder folder;
  folder.write("rock.prm", quick_rock);
  const auto outcome = run_feldspar(folder.path(), "lab rock.prm --output out --quiet",
                                    "env --unset=HOME --unset=USER TMPDIR=/nowhere TMP=/nowhere");
  EXPECT_EQ(outcome.exit_code, 0) << outcome.error;
  EXPECT_EQ(outcome.error, "");
  EXPECT_TRUE(fs::exists(folder.path() / "out/figures/direct_tension_stress.svg"));
}

TEST(Fault, AGnuplotThatFailsLeavesTheReportItsWords)
{
  const TemporaryFolder folder;
  folder.write("rock.prm", quick_rock);
  fs::create_directory(folder.path() / "bin");
  const fs::path gnuplot = folder.write("bin/gnuplot", "#!/bin/sh\nexit 1\n");
  fs::permissions(gnuplot, fs::perms::owner_all);
  const auto outcome = run_feldspar(folder.path(), "lab rock.prm --output out --quiet",
                                    "PATH='" + (folder.path() / "bin").string() + "':$PATH");
  EXPECT_EQ(outcome.exit_code, 0) << outcome.error;
  EXPECT_NE(content(folder.path() / "out/report.html").find("was not drawn"), std::string::npos);
}

/// A gnuplot that takes a minute.
void write_slow_gnuplot(const TemporaryFolder& folder)
{
  fs::create_directory(folder.path() / "bin");
  fs::permissions(folder.write("bin/gnuplot", "#!/bin/sh\nsleep 60\n"), fs::perms::owner_all);
}

// Pictures of some hundred tests take minutes: who asks a run to end does not wait for them.
TEST(Fault, AnInterruptedRunDoesNotWaitForItsPictures)
{
  const TemporaryFolder folder;
  folder.write("rock.prm", quick_rock);
  write_slow_gnuplot(folder);
  const std::string slow_path = "PATH='" + (folder.path() / "bin").string() + "':$PATH ";
  folder.write("end", "\"$@\" &\nuntil ls out/figures/*.gp >ls 2>&1; do sleep 0.02; done\n"
                      "kill -TERM $!\ndate +%s.%N >asked\nwait $!; code=$?\ndate +%s.%N >ended\nexit $code\n");
  const auto outcome =
    run_feldspar(folder.path(), "lab rock.prm --output out --quiet --threads 4", slow_path + "timeout 50 sh ./end");
  EXPECT_EQ(outcome.exit_code, 130) << outcome.error;
  EXPECT_LT(std::stod(content(folder.path() / "ended")) - std::stod(content(folder.path() / "asked")), 3.0);
  const std::string page = content(folder.path() / "out/report.html");
  EXPECT_NE(page.find("was not drawn: the run was asked to end before"), std::string::npos);
  EXPECT_TRUE(nlohmann::json::accept(content(folder.path() / "out/summary.json")));
  // Taken up it draws, and has nothing else to do.
  EXPECT_EQ(run_feldspar(folder.path(), "lab --resume out --quiet").exit_code, 0);
  EXPECT_EQ(content(folder.path() / "out/report.html").find("was not drawn"), std::string::npos);
  EXPECT_TRUE(fs::exists(folder.path() / "out/figures/direct_tension_stress.svg"));
}

// In genesis, in a test, at a checkpoint (there is one every few steps) or at the report, as it falls; then again in the run
// that takes it up.
TEST(Fault, KilledAtRandomMomentsTwiceInARowItIsResumedToTheSameBits)
{
  const TemporaryFolder folder;
  folder.write("rock.prm", quick_rock + "subsection Tests\n  set Steps between checkpoints = 10\nend\n");
  const auto begin = std::chrono::steady_clock::now();
  ASSERT_EQ(run_feldspar(folder.path(), "lab rock.prm --output whole --quiet --threads 1").exit_code, 0);
  const double whole = std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
  int n_killed = 0;
  Random random(1, RandomStream::positions);
  // A machine that is less busy than for the whole run is at the end before some of the moments come: then there are more.
  for (int k = 0; k < 3 || (n_killed < 3 && k < 10); ++k)
    {
      const std::string out = fmt::format("out-{}", k);
      const auto killed_after = [&](const std::string& arguments) {
        const auto outcome = run_feldspar(folder.path(), arguments + " --quiet --threads 1",
                                          fmt::format("timeout -s KILL {:.3f}", whole * random.uniform()));
        n_killed += outcome.exit_code == 137;
      };
      killed_after("lab rock.prm --output " + out);
      if (!fs::exists(folder.path() / out / "run.json")) // before there was anything
        fs::remove_all(folder.path() / out);
      const std::string go_on =
        fs::exists(folder.path() / out) ? "lab --resume " + out : "lab rock.prm --output " + out;
      killed_after(go_on);
      const bool has_begun = fs::exists(folder.path() / out / "run.json");
      const auto outcome = run_feldspar(
        folder.path(), (has_begun ? "lab --resume " + out : "lab rock.prm --force --output " + out) + " --quiet");
      EXPECT_EQ(outcome.exit_code, 0) << outcome.error;
      for (const char* file :
           {"curves/direct_tension_seed_1.csv", "cracks.csv", "emission.csv", "grains/direct_tension_seed_1.csv"})
        EXPECT_EQ(content(folder.path() / out / file), content(folder.path() / "whole" / file)) << out << "/" << file;
      expect_nothing_half_written(folder.path() / out);
      EXPECT_TRUE(fs::exists(folder.path() / out / "report.html"));
    }
  EXPECT_GE(n_killed, 3);
}

// Killed twice in a row, in genesis and at its end: what --resume makes of it is the unbroken run.
TEST(Fault, KilledInGenesisAndAtTheReportItIsResumed)
{
  const TemporaryFolder folder;
  folder.write("rock.prm", quick_rock);
  ASSERT_EQ(run_feldspar(folder.path(), "lab rock.prm --output whole --quiet").exit_code, 0);
  folder.write("kill", "file=$1; shift; \"$@\" &\nuntil [ -e $file ]; do sleep 0.005; done\nkill -KILL $!\nwait $!\n");
  EXPECT_EQ(
    run_feldspar(folder.path(), "lab rock.prm --output out --quiet", "timeout 20 sh ./kill out/run.json").exit_code,
    137);
  EXPECT_FALSE(fs::exists(folder.path() / "out/summary.json"));
  EXPECT_EQ(run_feldspar(folder.path(), "lab --resume out --quiet", "timeout 20 sh ./kill out/summary.json").exit_code,
            137);
  EXPECT_EQ(run_feldspar(folder.path(), "lab --resume out --quiet").exit_code, 0);
  EXPECT_EQ(content(folder.path() / "out/curves/direct_tension_seed_1.csv"),
            content(folder.path() / "whole/curves/direct_tension_seed_1.csv"));
  EXPECT_TRUE(fs::exists(folder.path() / "out/report.html"));
}
} // namespace
} // namespace feldspar::tests

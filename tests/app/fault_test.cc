#include "tests/app/result_files.h"
#include "tests/app/run_command.h"
#include "tests/temporary_folder.h"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
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

const std::string tiny_specimen = section("Specimen", "Width = 8 mm", "Height = 12 mm");

/// Over in half a second: a test that stops before its peak.
const std::string quick_rock = tiny_specimen + section("Tests", "List = direct_tension", "Stop strain = 2e-5");

/// A row of its test takes hours.
const std::string slow_rock =
  tiny_specimen + section("Tests", "List = direct_tension", "Tension strain rate = 1e-8 1/s");

/// Ends a command once it makes its tests, which it says.
Outcome interrupted_in_tests(const TemporaryFolder& folder, const std::string& arguments)
{
  const Outcome outcome =
    run_until(folder, arguments, "grep -sq tests '" + folder.path().string() + ".stderr'", "kill -TERM $!");
  EXPECT_EQ(outcome.exit_code, 130) << outcome.error;
  return outcome;
}

/// A command of each kind, of seconds at most; `report` is of the folder "whole".
struct CommandOfEachKind
{
  std::string arguments; ///< without --output
  std::string input;
};

const std::vector<CommandOfEachKind>& commands_of_each_kind()
{
  static const std::string rock = quick_rock;
  static const std::string cell = section("Specimen", "Shape = periodic", "Width = 12 mm", "Height = 12 mm");
  static const std::vector<CommandOfEachKind> all{
    {"lab rock.prm", rock},
    {"specimen rock.prm", rock},
    {"contact contact.prm", section("Contact path", "File = path.csv")},
    {"rve cell.prm", cell + section("Strain path", "Direction = 1, 0, 0", "Size = 2e-5")},
    {"multiscale sample.prm", section("Sample", "Material = linear elasticity") +
                                section("Tests", "List = direct_tension", "Stop strain = 1e-5")},
    {"calibrate calibrate.prm", rock + section("Report", "Reference file = rock.json")},
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

/// A fault that ends a command: code 3 and one line.
void expect_one_line(const Outcome& outcome, const std::string& words)
{
  EXPECT_EQ(outcome.exit_code, 3);
  EXPECT_EQ(n_lines(outcome.error), 1u) << outcome.error;
  EXPECT_TRUE(has_words(outcome.error, words));
}

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
  run_to_end(folder, "lab rock.prm --output whole --quiet");
  int n_met = 0;
  for (const int n_writes : {0, 1, 2, 12, 40, 200, 400}) // of some 450, most of them of checkpoints
    {
      const std::string out = fmt::format("out-{}", n_writes);
      const auto outcome =
        run_feldspar(folder, "lab rock.prm --output " + out + " --quiet",
                     fmt::format("LD_PRELOAD='{}' FELDSPAR_WRITES_LEFT={}", FELDSPAR_FULL_DISK, n_writes));
      expect_one_line(outcome, "No space left on device");
      EXPECT_FALSE(n_writes == 0 && fs::exists(folder / out)) << "where not even the beginning is kept nothing is left";
      if (!fs::exists(folder / out))
        continue;
      EXPECT_TRUE(has_words(outcome.error, "feldspar lab --resume " + out));
      expect_nothing_half_written(folder / out);
      ++n_met;
      if (n_writes == 12 || n_writes == 400)
        {
          EXPECT_EQ(run_to_end(folder, "lab --resume " + out + " --quiet").error, "");
          expect_same_files(folder / "whole", folder / out, {"curves/direct_tension_seed_1.csv"});
        }
    }
  EXPECT_GE(n_met, 4);
}

TEST(Fault, AFullDiskIsSaidInOneLineByEachCommand)
{
  const TemporaryFolder folder;
  write_inputs(folder);
  run_to_end(folder, "lab rock.prm --output whole --quiet");
  for (const auto& [arguments, input] : commands_of_each_kind())
    for (const int n_writes : {0, 3})
      {
        if (n_writes > 0 && (arguments.starts_with("specimen") || arguments.starts_with("contact") ||
                             arguments.starts_with("calibrate")))
          continue; // two write no more, and the third makes many specimens before it does
        const auto outcome =
          run_feldspar(folder, fmt::format("{} --output out --force --quiet", arguments),
                       fmt::format("LD_PRELOAD='{}' FELDSPAR_WRITES_LEFT={}", FELDSPAR_FULL_DISK, n_writes));
        SCOPED_TRACE(arguments);
        expect_one_line(outcome, "No space left on device");
        if (fs::exists(folder / "out"))
          expect_nothing_half_written(folder / "out");
        fs::remove_all(folder / "out");
      }
}

// From the beginning, or from some change on, as a file system does that met an error of its disk.
TEST(Fault, AFileSystemThatIsReadOnlyIsSaidInOneLineByEachCommand)
{
  const TemporaryFolder folder;
  write_inputs(folder);
  run_to_end(folder, "lab rock.prm --output whole --quiet");
  const std::string page = content(folder / "whole/report.html");
  for (const auto& [arguments, input] : commands_of_each_kind())
    for (const int n_changes : {0, 2, 5})
      {
        // The first change is the folder itself, a mistake in the choice of which is the user's.
        if (n_changes > 2 && (arguments.starts_with("specimen") || arguments.starts_with("contact") ||
                              arguments.starts_with("calibrate")))
          continue; // two change no more, and the third makes many specimens before it does
        const auto outcome =
          run_feldspar(folder, arguments + " --output out --quiet",
                       fmt::format("LD_PRELOAD='{}' FELDSPAR_CHANGES_LEFT={}", FELDSPAR_READ_ONLY, n_changes));
        EXPECT_EQ(outcome.exit_code, n_changes == 0 ? 2 : 3) << arguments << ", " << n_changes;
        EXPECT_EQ(n_lines(outcome.error), 1u) << arguments << ", " << n_changes << ": " << outcome.error;
        EXPECT_TRUE(has_words(outcome.error, "Read-only file system")) << arguments;
        EXPECT_FALSE(n_changes == 0 && fs::exists(folder / "out")) << arguments;
        fs::remove_all(folder / "out");
      }
  // A report into the folder of its results.
  expect_one_line(run_feldspar(folder, "report whole --quiet", fmt::format("LD_PRELOAD='{}'", FELDSPAR_READ_ONLY)), "");
  EXPECT_EQ(content(folder / "whole/report.html"), page);
}

// A folder that was moved may come back: nothing is lost.
TEST(Fault, AFolderThatGoesDuringTheRunIsSaidInOneLineAndTakenUpWhereItIs)
{
  const TemporaryFolder folder;
  folder.write("rock.prm", slow_rock);
  for (const std::string how : {"rm -r out", "mv out moved"})
    {
      expect_one_line(run_until(folder, "lab rock.prm --output out --quiet", "[ -e out/specimen.h5 ]",
                                "sleep 0.2\n" + how + "\nkill -TERM $!"),
                      "No such file or directory");
      EXPECT_FALSE(fs::exists(folder / "out"));
    }
  const std::string specimen = content(folder / "moved/specimen.h5");
  interrupted_in_tests(folder, "lab --resume moved");
  EXPECT_EQ(content(folder / "moved/specimen.h5"), specimen);
}

// Another width, or the same packing with another density.
TEST(Fault, AnotherSpecimenInTheFolderIsNotTakenForThatOfTheRun)
{
  const TemporaryFolder folder;
  folder.write("rock.prm", slow_rock);
  interrupted_in_tests(folder, "lab rock.prm --output out");
  const std::string own = content(folder / "out/specimen.h5");
  for (const std::string change : {"Specimen/Width = 12 mm", "Specimen/Density = 1350 kg/m^3"})
    {
      SCOPED_TRACE(change);
      run_to_end(folder, "specimen rock.prm --output other --force --quiet --set '" + change + "'");
      fs::copy_file(folder / "other/specimen.h5", folder / "out/specimen.h5", fs::copy_options::overwrite_existing);
      const std::string said = interrupted_in_tests(folder, "lab --resume out").error;
      EXPECT_TRUE(has_words(said, "specimen.h5: not the specimen of this run; making it anew"));
      EXPECT_EQ(said.find("going back"), std::string::npos) << said;
      EXPECT_EQ(content(folder / "out/specimen.h5"), own);
    }
}

TEST(Fault, AClockThatGoesBackChangesNothing)
{
  const TemporaryFolder folder;
  folder.write("rock.prm", quick_rock);
  run_to_end(folder, "lab rock.prm --output whole --quiet");
  const std::string going_back = fmt::format("LD_PRELOAD='{}'", FELDSPAR_CLOCK_GOING_BACK);
  // A clock that goes as ever would pass all below.
  const auto now = run_command(folder, "date +%s");
  const auto set_back = run_command(folder, going_back + " date +%s");
  EXPECT_LT(std::stol(set_back.output), std::stol(now.output) - 3000);
  const auto outcome = run_to_end(folder, "lab rock.prm --output out --quiet", going_back);
  EXPECT_EQ(outcome.error, "");
  for (const char* file : {"curves/direct_tension_seed_1.csv", "cracks.csv"}) // HDF5 keeps the time of the day
    EXPECT_EQ(content(folder / "out" / file), content(folder / "whole" / file)) << file;
  const auto summary = summary_of(folder / "out");
  const double seconds = summary["tests"][0]["wall_time_s"].get<double>();
  EXPECT_GE(seconds, 0.0);
  EXPECT_LT(seconds, 60.0);
}

TEST(Fault, AStandardOutputThatIsClosedFullOrLeftDoesNotCostTheRun)
{
  const TemporaryFolder folder;
  folder.write("rock.prm", quick_rock);
  run_to_end(folder, "lab rock.prm --output whole --quiet");
  const auto same = [&](const std::string& out) {
    expect_same_files(folder / out, folder / "whole", {"curves/direct_tension_seed_1.csv", "cracks.csv"});
    EXPECT_TRUE(nlohmann::json::accept(content(folder / out / "summary.json"))) << out;
    EXPECT_TRUE(read_json(folder / out / "run.json")["complete"].get<bool>()) << out;
  };
  // Closed: its number must not go to the first file that is opened.
  run_to_end(folder, "lab rock.prm --output closed >&- 2>&- <&-");
  same("closed");
  expect_one_line(run_without_pictures(folder, "lab rock.prm --output full --quiet > /dev/full"), "standard output");
  same("full");
  // Who reads along goes away, also from the progress.
  run_feldspar(folder, "lab rock.prm --output left 2>&1 | head -c 1");
  same("left");
  folder.write("sample.prm", section("Specimen", "Shape = periodic", "Width = 10 mm", "Height = 10 mm") +
                               section("Sample", "Width = 10 mm", "Height = 10 mm", "Elements across = 1",
                                       "Elements along = 1", "Realisations = 1") +
                               section("Tests", "List = direct_tension", "Stop strain = 5e-5"));
  run_feldspar(folder, "multiscale sample.prm --output sample 2>&1 | head -c 1");
  EXPECT_TRUE(nlohmann::json::accept(content(folder / "sample/summary.json")));
  expect_one_line(run_feldspar(folder, "parameters > /dev/full"), "");
}

TEST(Fault, OneFolderTakesOneRunAtATime)
{
  const TemporaryFolder folder;
  folder.write("rock.prm", slow_rock);
  std::string others;
  for (const std::string arguments : {"lab --resume out", "lab rock.prm --output out --force",
                                      "specimen rock.prm --output out --force", "report out"})
    others += "'" FELDSPAR_COMMAND "' " + arguments + " --quiet; echo $?\n";
  const auto outcome =
    run_until(folder, "lab rock.prm --output out --quiet", "[ -e out/specimen.h5 ]", others + "kill -TERM $!");
  EXPECT_EQ(outcome.exit_code, 130);
  EXPECT_EQ(outcome.output, "2\n2\n2\n2\nout\n");
  const std::string refusal = "feldspar: out: another feldspar works in this folder; ";
  EXPECT_EQ(outcome.error.find(refusal), 0u) << outcome.error;
  std::size_t n_refusals = 0;
  for (std::size_t at = 0; (at = outcome.error.find(refusal, at)) != std::string::npos; ++at)
    ++n_refusals;
  EXPECT_EQ(n_refusals, 4u) << outcome.error;
  EXPECT_TRUE(fs::exists(folder / "out/run.json"));
}

// Names of folders come from others, and a terminal obeys escape characters.
TEST(Output, OfAFolderWhoseNameHasControlCharactersIsPrintable)
{
  const TemporaryFolder folder;
  write_inputs(folder);
  run_to_end(folder, "lab rock.prm --output whole --quiet");
  for (const auto& [arguments, input] : commands_of_each_kind())
    {
      const std::string command = arguments.substr(0, arguments.find(' '));
      if (command == "calibrate")
        continue; // takes the longest, and ends as lab does
      SCOPED_TRACE(command);
      const auto outcome = run_to_end(folder, arguments + " --output \"$(printf '" + command + "\\033[31m')\"");
      EXPECT_EQ((outcome.output + outcome.error).find('\x1b'), std::string::npos);
      EXPECT_TRUE(has_words(outcome.output, command + "\\x1b[31m"));
    }
}

// A test that runs to 1.6 times the strain at its peak, as most do: steps within a factor of two.
TEST(Load, StepsMemoryAndTimeOfTestsAreSaidBeforehand)
{
  const TemporaryFolder folder;
  folder.write("rock.prm", tiny_specimen + section("Tests", "List = direct_tension"));
  const auto outcome = run_to_end(folder, "lab rock.prm --output out");
  static const std::regex words(
    R"(1 test of some (\d+) steps: about (\d+) MB with specimens and program, (\d+) s\s+with\s+pictures)");
  std::smatch said;
  ASSERT_TRUE(std::regex_search(outcome.error, said, words)) << outcome.error;
  const auto summary = summary_of(folder / "out");
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
  expect_refused(folder, "lab rock.prm --output out", "Tests: 2000 test(s) of 1 specimen(s)");
}

// The rate of the test is 1e-24 of the usual one, which takes a hundred thousand steps.
TEST(Load, TestsThatWouldNotEndAreRefused)
{
  const TemporaryFolder folder;
  folder.write("rock.prm", quick_rock);
  const auto outcome = run_without_pictures(
    folder.path(), "lab rock.prm --output out --quiet --set 'Tests/Tension strain rate = 1e-25 1/s'");
  EXPECT_EQ(outcome.exit_code, 2);
  EXPECT_TRUE(has_words(outcome.error, "steps; a strain rate is far too low"));
}

TEST(Fault, NeedsNoHomeAndNoFolderForTemporaryFiles)
{
  const TemporaryFolder folder;
  folder.write("rock.prm", quick_rock);
  const auto outcome = run_to_end(folder, "lab rock.prm --output out --quiet",
                                  "env --unset=HOME --unset=USER TMPDIR=/nowhere TMP=/nowhere");
  EXPECT_EQ(outcome.error, "");
  EXPECT_TRUE(fs::exists(folder / "out/figures/direct_tension_stress.svg"));
}

TEST(Fault, AGnuplotThatFailsLeavesTheReportItsWords)
{
  const TemporaryFolder folder;
  folder.write("rock.prm", quick_rock);
  run_to_end(folder, "lab rock.prm --output out --quiet", path_without_pictures());
  EXPECT_TRUE(has_words(content(folder / "out/report.html"), "was not drawn"));
}

// Pictures of some hundred tests take minutes: who asks a run to end does not wait for them.
TEST(Fault, AnInterruptedRunDoesNotWaitForItsPictures)
{
  const TemporaryFolder folder;
  folder.write("rock.prm", quick_rock);
  fs::create_directory(folder / "bin");
  fs::permissions(folder.write("bin/gnuplot", "#!/bin/sh\nsleep 60\n"), fs::perms::owner_all);
  const std::string slow_path = "PATH='" + (folder / "bin").string() + "':$PATH";
  const auto outcome = run_until(
    folder, "lab rock.prm --output out --quiet --threads 4", "ls out/figures/*.gp >ls 2>&1",
    "kill -TERM $!\ndate +%s.%N >asked\nwait $!; code=$?\ndate +%s.%N >ended\nexit $code", "env " + slow_path);
  EXPECT_EQ(outcome.exit_code, 130) << outcome.error;
  EXPECT_LT(std::stod(content(folder / "ended")) - std::stod(content(folder / "asked")), 3.0);
  const std::string page = content(folder / "out/report.html");
  EXPECT_TRUE(has_words(page, "was not drawn: the run was asked to end before"));
  EXPECT_TRUE(nlohmann::json::accept(content(folder / "out/summary.json")));
  // Taken up it draws, and has nothing else to do.
  run_to_end(folder, "lab --resume out --quiet", with_pictures);
  EXPECT_EQ(content(folder / "out/report.html").find("was not drawn"), std::string::npos);
  EXPECT_TRUE(fs::exists(folder / "out/figures/direct_tension_stress.svg"));
}

// Killed twice in a row, in genesis and at its end: what --resume makes of it is the unbroken run.
TEST(Fault, KilledInGenesisAndAtTheReportItIsResumed)
{
  const TemporaryFolder folder;
  folder.write("rock.prm", quick_rock);
  run_to_end(folder, "lab rock.prm --output whole --quiet");
  const auto killed_at = [&](const std::string& arguments, const std::string& file) {
    EXPECT_EQ(run_until(folder, arguments, "[ -e " + file + " ]", "kill -KILL $!").exit_code, 137);
  };
  killed_at("lab rock.prm --output out --quiet", "out/run.json");
  EXPECT_FALSE(fs::exists(folder / "out/summary.json"));
  killed_at("lab --resume out --quiet", "out/summary.json");
  run_to_end(folder, "lab --resume out --quiet");
  expect_same_files(folder / "whole", folder / "out", {"curves/direct_tension_seed_1.csv"});
  EXPECT_TRUE(fs::exists(folder / "out/report.html"));
}
} // namespace
} // namespace feldspar::tests

#include "tests/app/result_files.h"
#include "tests/app/run_command.h"
#include "tests/temporary_folder.h"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <sstream>
#include <string>
#include <utility>
#include <vector>

#include <unistd.h>

/// `mpirun feldspar multiscale`, and runs that cannot be lost.
namespace feldspar::tests
{
namespace
{
namespace fs = std::filesystem;

/// Eight elements of 12 mm with RVEs of some 75 grains. Newton's tolerance is far below what events and fields are
/// compared to.
const std::string pull_of_ranks =
  section("Specimen", "Shape = periodic", "Width = 14 mm", "Height = 14 mm") +
  section("Sample", "Width = 24 mm", "Height = 48 mm", "Elements across = 2", "Elements along = 4", "Realisations = 2",
          "Tension step = 1e-5", "Newton tolerance = 1e-10") +
  section("Tests", "List = direct_tension", "Stop strain = 2.2e-4") +
  section("Seeds", "Seeds = 4"); // much breaks at once

const std::string test_name = "direct_tension_seed_4";

/// The first cells of each row.
std::vector<std::string> first_cells(const fs::path& file, const int n)
{
  std::vector<std::string> rows;
  std::istringstream lines(content(file));
  for (std::string line; std::getline(lines, line);)
    {
      std::size_t end = 0;
      for (int c = 0; c < n; ++c)
        end = line.find(',', end + 1);
      rows.push_back(line.substr(0, end));
    }
  return rows;
}

std::vector<std::string> sorted_names(const fs::path& folder)
{
  std::vector<std::string> names;
  for (const auto& entry : fs::directory_iterator(folder))
    names.push_back(entry.path().filename().string());
  std::sort(names.begin(), names.end());
  return names;
}

void expect_near(const std::vector<double>& one, const std::vector<double>& other, const double relative,
                 const double absolute, const std::string& what)
{
  ASSERT_EQ(one.size(), other.size()) << what;
  for (std::size_t k = 0; k < one.size(); ++k)
    EXPECT_NEAR(one[k], other[k], relative * std::abs(one[k]) + absolute) << what << " in row " << k + 1;
}

/// Same segments of the same points, in the same steps and order; curves to 1e-8 of their largest value.
void expect_same_run(const fs::path& one, const fs::path& other, const std::size_t least_cracks = 15)
{
  const auto cracks = first_cells(one / "cracks.csv", 5);                        // test, kind, joint, segment, step
  EXPECT_GT(cracks.size(), least_cracks) << "too little broke for a comparison"; // with the line of names
  ASSERT_EQ(cracks, first_cells(other / "cracks.csv", 5));

  const auto events = first_cells(one / "emission.csv", 2); // number, step
  ASSERT_GT(events.size(), 1u);
  ASSERT_EQ(events, first_cells(other / "emission.csv", 2));
  expect_near(column(one / "emission.csv", "moment_Nm"), column(other / "emission.csv", "moment_Nm"), 1e-5, 0.0,
              "moment");

  // Each step took as many iterations, cascades and cuts. Sums over ranks differ by round-off, and with them residuals near it.
  auto steps = read_columns(one / "steps.csv");
  auto other_steps = read_columns(other / "steps.csv");
  ASSERT_GT(steps.at("residual").size(), 0u);
  expect_near(steps.at("residual"), other_steps.at("residual"), 0.1, 1e-7, "residual");
  steps.erase("residual");
  other_steps.erase("residual");
  EXPECT_EQ(steps, other_steps);

  const auto curve = read_columns(one / "curves" / (test_name + ".csv"));
  const auto other_curve = read_columns(other / "curves" / (test_name + ".csv"));
  for (const std::string name : {"axial_stress_Pa", "mid_stress_Pa", "gauge_lateral_strain", "released_energy_J"})
    {
      double largest = 0.0;
      for (const double value : curve.at(name))
        largest = std::max(largest, std::abs(value));
      expect_near(curve.at(name), other_curve.at(name), 0.0, 1e-8 * largest, name);
    }

  // The same RVEs are kept for the report, whichever rank they were on.
  const auto rves = sorted_names(one / "points");
  EXPECT_GE(rves.size(), 4u); // grains and cracks of two at least
  ASSERT_EQ(rves, sorted_names(other / "points"));
  for (const std::string& name : rves)
    {
      EXPECT_EQ(n_lines(content(one / "points" / name)), n_lines(content(other / "points" / name))) << name;
      if (name.ends_with("_grains.csv"))
        for (const char* const place : {"start_x_m", "start_y_m", "start_z_m", "x_m", "y_m", "z_m"})
          expect_near(column(one / "points" / name, place), column(other / "points" / name, place), 0.0, 1e-10, name);
    }
}

/// Names of the checkpoints of a run.
std::vector<std::string> checkpoints(const fs::path& run) { return sorted_names(run / "states" / test_name); }

/// Runs it, and acts on it once there are so many checkpoints in FOLDER.
Outcome run_until_checkpoints(const TemporaryFolder& folder, const std::string& arguments, const unsigned int n,
                              const std::string& of, const std::string& action, const std::string& launcher = "")
{
  return run_until(folder, arguments,
                   fmt::format("[ $(ls -d {}/states/{}/step-* 2>/dev/null | wc -l) -ge {} ]", of, test_name, n), action,
                   launcher);
}

TEST(SeveralRanks, BreakTheSameSegments)
{
  const TemporaryFolder folder;
  folder.write("pull.prm", pull_of_ranks);
  run_to_end(folder, "multiscale pull.prm --output 1 --quiet --threads 1");
  run_to_end(folder, "multiscale pull.prm --output 2 --quiet --threads 2", mpirun(2));
  run_to_end(folder, "multiscale pull.prm --output 4 --quiet --threads 1", mpirun(4));
  expect_same_run(folder / "1", folder / "2");
  expect_same_run(folder / "1", folder / "4");
  // The sample tears in one row of elements, whose ranks have nearly all the work until some of their cells move.
  const auto ranks_of = [&](const char* run) { return summary_of(folder / run)["tests"][0]["ranks"]; };
  EXPECT_EQ(ranks_of("1")["moves"], 0);
  EXPECT_EQ(ranks_of("1")["longest_s"], ranks_of("1")["mean_s"]);
  for (const char* run : {"2", "4"})
    EXPECT_GE(ranks_of(run)["moves"], 1) << run;
  EXPECT_GT(ranks_of("2")["longest_unmoved_s"].get<double>(), 1.4 * ranks_of("2")["mean_s"].get<double>());
  EXPECT_LT(ranks_of("2")["longest_s"], ranks_of("2")["longest_unmoved_s"]);
  // The last two checkpoints, a part a rank.
  const auto kept = checkpoints(folder / "4");
  ASSERT_EQ(kept.size(), 2u);
  for (const auto& checkpoint : kept)
    EXPECT_EQ(sorted_names(folder / "4/states" / test_name / checkpoint).size(), 4u);
}

TEST(SeveralRanks, BreakTheSameSegmentsOfCylinders)
{
  const TemporaryFolder folder;
  // RVEs of some 50 spheres.
  const std::string pull = section("Specimen", "Dimension = 3", "Shape = periodic", "Width = 6 mm", "Height = 6 mm") +
                           section("Sample", "Width = 12 mm", "Height = 24 mm", "Elements along = 2",
                                   "Realisations = 1", "Tension step = 2e-5", "Newton tolerance = 1e-10") +
                           section("Tests", "List = direct_tension", "Stop strain = 1.6e-4") +
                           section("Seeds", "Seeds = 4");
  for (const std::string& geometry : {section("Sample", "Geometry = axisymmetric", "Elements across = 1"),
                                      section("Sample", "Geometry = cylinder", "Elements across = 3")})
    {
      folder.write("pull.prm", pull + geometry);
      run_to_end(folder, "multiscale pull.prm --output 1 --force --quiet --threads 1");
      run_to_end(folder, "multiscale pull.prm --output 2 --force --quiet --threads 1", mpirun(2));
      expect_same_run(folder / "1", folder / "2", 1);
    }
}

TEST(SeveralRanks, OneThatDiesOrIsAskedToEndEndsTheRunWhichIsResumedOnAnyNumber)
{
  const TemporaryFolder folder;
  folder.write("pull.prm", pull_of_ranks);
  run_to_end(folder, "multiscale pull.prm --output whole --quiet");
  const auto killed = run_until_checkpoints(folder, "multiscale pull.prm --output two --quiet", 1, "two",
                                            "kill -KILL $(pgrep -P $! | head -n 1)", mpirun(2));
  EXPECT_NE(killed.exit_code, 0);
  EXPECT_TRUE(has_words(killed.error, "signal 9")); // mpirun says so
  EXPECT_FALSE(fs::exists(folder / "two/summary.json"));
  fs::copy(folder / "two", folder / "one", fs::copy_options::recursive);
  const auto asked =
    run_until_checkpoints(folder, "multiscale pull.prm --output out --quiet", 1, "out", "kill -USR1 $!",
                          mpirun(2)); // which passes it on to all
  EXPECT_EQ(asked.exit_code, 130) << asked.error;
  EXPECT_TRUE(has_words(asked.error, "feldspar: interrupted; go on with: feldspar multiscale --resume out\n"));
  for (const auto& [run, n_ranks] : {std::pair("one", 1u), {"two", 3u}, {"out", 1u}})
    {
      run_to_end(folder, fmt::format("multiscale --resume {} --quiet", run),
                 n_ranks > 1 ? mpirun(n_ranks) : path_without_pictures());
      expect_same_run(folder / "whole", folder / run);
    }
}

TEST(SeveralRanks, SayOnceWhatIsWrong)
{
  const TemporaryFolder folder;
  const auto refused = [&](const std::string& text, const unsigned int n_ranks, const std::string& words) {
    folder.write("bad.prm", text);
    const auto outcome = run_feldspar(folder, "multiscale bad.prm --output out", mpirun(n_ranks));
    EXPECT_EQ(outcome.exit_code, 2) << outcome.error;
    const auto said = outcome.error.find(words);
    EXPECT_NE(said, std::string::npos) << outcome.error;
    EXPECT_EQ(outcome.error.find(words, said + 1), std::string::npos) << outcome.error;
    EXPECT_FALSE(fs::exists(folder / "out"));
  };
  refused(pull_of_ranks + section("Sample", "Order = 3"), 2, "Sample/Order = 3: must be an integer in [1, 2]");
  refused(replaced(replaced(pull_of_ranks, "across = 2", "across = 1"), "along = 4", "along = 2"), 3,
          "bad.prm: 3 processes for a sample of 2 cells: each needs one; start at most 2");
  refused(replaced(pull_of_ranks, "Realisations = 2", "Realisations = 1") +
            section("Specimen", "Specimen file = none.h5"),
          2, "there is no file none.h5");
}

/// Three specimens of some 90 grains, a test each.
const std::string programme = section("Specimen", "Width = 12 mm", "Height = 24 mm") +
                              section("Tests", "List = direct_tension") + section("Seeds", "Seeds = 1..3");

/// Files of the same names with the same bytes.
void expect_same_folders(const fs::path& one, const fs::path& other, const std::size_t n)
{
  const auto names = sorted_names(one);
  EXPECT_EQ(names.size(), n);
  expect_same_files(one, other, names);
}

// Ranks take whole tests, each of which has its bits whoever makes it.
TEST(SeveralRanks, OfTheLaboratoryHaveTheBitsOfOne)
{
  const TemporaryFolder folder;
  folder.write("rock.prm", programme);
  run_to_end(folder, "lab rock.prm --output one --quiet");
  run_to_end(folder, "lab rock.prm --output two --quiet --threads 1", mpirun(2));
  expect_same_folders(folder / "one/curves", folder / "two/curves", 3);
  expect_same_folders(folder / "one/grains", folder / "two/grains", 3);
  expect_same_files(folder / "one", folder / "two", {"cracks.csv", "emission.csv"});
  EXPECT_FALSE(fs::exists(folder / "two/checkpoints"));

  // Asked to end, all end; one process resumes what they left.
  const auto asked = run_until(folder, "lab rock.prm --output out --quiet --threads 1",
                               "ls out/checkpoints/*.h5 >/dev/null 2>&1", "kill -USR1 $!", mpirun(2));
  EXPECT_EQ(asked.exit_code, 130) << asked.error;
  EXPECT_TRUE(has_words(asked.error, "feldspar: interrupted; go on with: feldspar lab --resume out\n"));
  run_to_end(folder, "lab --resume out --quiet");
  expect_same_folders(folder / "one/curves", folder / "out/curves", 3);

  // An error is said once, and leaves nothing.
  const auto wrong = run_feldspar(folder, "lab rock.prm --output bad --set 'Specimen/Width = 0.1 mm'", mpirun(2));
  EXPECT_EQ(wrong.exit_code, 2) << wrong.error;
  EXPECT_EQ(wrong.error.find("feldspar: "), wrong.error.rfind("feldspar: ")) << wrong.error;
  EXPECT_FALSE(fs::exists(folder / "bad"));
}

TEST(SeveralRanks, TakePathsOfCells)
{
  const TemporaryFolder folder;
  folder.write("path.csv", "strain_xx,strain_yy,strain_xy\n0,0,0\n0,2e-4,0\n");
  folder.write("cell.prm", section("Specimen", "Shape = periodic", "Width = 12 mm", "Height = 12 mm") +
                             section("Strain path", "File = path.csv") + section("Seeds", "Seeds = 1..3"));
  run_to_end(folder, "rve cell.prm --output one --quiet");
  run_to_end(folder, "rve cell.prm --output two --quiet --threads 1", mpirun(2));
  expect_same_folders(folder / "one/curves", folder / "two/curves", 3);
}

/// The batch script of docs/cluster.md: a job that is told that its time ends writes a checkpoint and hands on to the next.
TEST(SeveralRanks, FollowEachOtherUnderSlurm)
{
  if (geteuid() != 0 || !fs::exists("/usr/sbin/slurmctld"))
    GTEST_SKIP() << "needs root and the package slurm-wlm";
  const TemporaryFolder folder;
  folder.write("pull.prm", replaced(pull_of_ranks, "step = 1e-5", "step = 3e-7"));
  const auto trial = run_command(folder, "OMPI_MCA_mpi_yield_when_idle=1 '" FELDSPAR_SOURCE_DIR
                                         "/scripts/slurm-trial.sh' '" FELDSPAR_COMMAND "' pull.prm slurm");
  if (trial.exit_code == 77)
    GTEST_SKIP() << "Slurm does not come up here: " << trial.output;
  ASSERT_EQ(trial.exit_code, 0) << trial.output << trial.error;
  EXPECT_TRUE(has_words(trial.output, "Exited with exit code 130", "JobId=2"));
  run_to_end(folder, "multiscale pull.prm --output whole --quiet");
  expect_same_run(folder / "whole", folder / "slurm/RUN");
}

// Files of more than 28 kB cannot be written from some moment on; a checkpoint of this sample has more than 30.
TEST(Checkpoints, OneThatIsDamagedOrDoesNotFitIsRefusedAndTheOneBeforeItUsed)
{
  const TemporaryFolder folder;
  folder.write("pull.prm", pull_of_ranks);
  run_to_end(folder, "multiscale pull.prm --output whole --quiet");
  run_until_checkpoints(folder, "multiscale pull.prm --output broken --quiet", 2, "broken", "kill -KILL $!");
  const auto kept = checkpoints(folder / "broken");
  ASSERT_GE(kept.size(), 2u);
  const std::string last = "/states/" + test_name + "/" + kept[1] + "/part-00000.h5";
  const auto resumed = [&](const std::string& name, const auto& damage, const std::string& words) {
    fs::copy(folder / "broken", folder / name, fs::copy_options::recursive);
    const std::string file = name + last;
    damage(folder / file);
    const auto outcome = run_to_end(folder, "multiscale --resume " + name + " --quiet");
    EXPECT_TRUE(has_words(outcome.error, file + ": " + words, "going back to the checkpoint before it\n"));
    EXPECT_EQ(n_lines(outcome.error), 1u) << outcome.error;
    expect_same_run(folder / "whole", folder / name);
  };
  resumed(
    "torn", [](const fs::path& file) { fs::resize_file(file, fs::file_size(file) / 2); }, "damaged or cut short");
  resumed(
    "missing", [](const fs::path& file) { fs::remove(file); }, "cannot be read: No such file");
  folder.write("other.prm", replaced(pull_of_ranks, "2.2e-4", "2e-5"));
  run_to_end(folder, "multiscale other.prm --output other --quiet");
  resumed(
    "foreign",
    [&](const fs::path& file) {
      fs::copy_file(folder / "other/states" / test_name / checkpoints(folder / "other").back() / "part-00000.h5", file,
                    fs::copy_options::overwrite_existing);
    },
    "of another test, input or version of this program");

  const auto full = run_until_checkpoints(folder, "multiscale pull.prm --output out --quiet --threads 1", 1, "out",
                                          "prlimit --pid $! --fsize=28000", "env --ignore-signal=XFSZ");
  EXPECT_EQ(full.exit_code, 3) << full.error;
  const auto left = checkpoints(folder / "out");
  ASSERT_FALSE(left.empty());
  EXPECT_TRUE(has_words(full.error, "cannot be written: File too large; what is kept is out/states/" + test_name + "/" +
                                      left.back() + "; once it can, go on with: feldspar multiscale --resume out\n"));
  EXPECT_FALSE(fs::exists(folder / "out/states" / test_name / "unfinished"));
  run_to_end(folder, "multiscale --resume out --quiet");
  expect_same_run(folder / "whole", folder / "out");
}
} // namespace
} // namespace feldspar::tests

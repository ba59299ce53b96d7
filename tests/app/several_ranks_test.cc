#include "tests/app/run_command.h"
#include "tests/temporary_folder.h"

#include <fmt/format.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

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
namespace feldspar
{
namespace
{
namespace fs = std::filesystem;
using tests::mpirun;
using tests::Outcome;
using tests::run_feldspar;
using tests::run_without_pictures;
using tests::TemporaryFolder;

/// Eight elements of 12 mm with RVEs of some 75 grains. Newton's tolerance is far below what events and fields are
/// compared to.
const std::string pull_of_ranks =
  "subsection Specimen\n  set Shape = periodic\n  set Width = 14 mm\n  set Height = 14 mm\nend\n"
  "subsection Sample\n  set Width = 24 mm\n  set Height = 48 mm\n"
  "  set Elements across = 2\n  set Elements along = 4\n  set Realisations = 2\n"
  "  set Tension step = 1e-5\n  set Newton tolerance = 1e-10\nend\n"
  "subsection Tests\n  set List = direct_tension\n  set Stop strain = 2.2e-4\nend\n"
  "subsection Seeds\n  set Seeds = 4\nend\n"; // much breaks at once

const std::string test_name = "direct_tension_seed_4";

std::vector<std::vector<std::string>> table(const fs::path& file)
{
  std::vector<std::vector<std::string>> rows;
  std::ifstream in(file);
  for (std::string line; std::getline(in, line);)
    {
      rows.emplace_back();
      std::istringstream cells(line);
      for (std::string cell; std::getline(cells, cell, ',');)
        rows.back().push_back(cell);
    }
  return rows;
}

/// Same segments of the same points, in the same steps and order; curves to 1e-8 of their largest value.
void expect_same_run(const fs::path& one, const fs::path& other, const std::size_t least_cracks = 15)
{
  const auto cracks = table(one / "cracks.csv");
  const auto other_cracks = table(other / "cracks.csv");
  EXPECT_GT(cracks.size(), least_cracks) << "too little broke for a comparison"; // with the line of names
  ASSERT_EQ(cracks.size(), other_cracks.size());
  for (std::size_t k = 0; k < cracks.size(); ++k)
    for (std::size_t c = 0; c < 5; ++c) // test, kind, joint, segment, step
      ASSERT_EQ(cracks[k][c], other_cracks[k][c]) << "line " << k + 1;

  const auto events = table(one / "emission.csv");
  const auto other_events = table(other / "emission.csv");
  ASSERT_EQ(events.size(), other_events.size());
  ASSERT_GT(events.size(), 1u);
  const auto moment = std::size_t(std::find(events[0].begin(), events[0].end(), "moment_Nm") - events[0].begin());
  ASSERT_LT(moment, events[0].size());
  for (std::size_t k = 1; k < events.size(); ++k)
    {
      for (std::size_t c = 0; c < 2; ++c) // number, step
        ASSERT_EQ(events[k][c], other_events[k][c]) << "line " << k + 1;
      const double of_one = std::stod(events[k][moment]);
      EXPECT_NEAR(of_one, std::stod(other_events[k][moment]), 1e-5 * of_one) << "line " << k + 1;
    }

  // Each step took as many iterations, cascades and cuts. Sums over ranks differ by round-off, and with them residuals near it.
  auto steps = table(one / "steps.csv");
  auto other_steps = table(other / "steps.csv");
  ASSERT_EQ(steps.size(), other_steps.size());
  ASSERT_GT(steps.size(), 1u);
  const auto residual = std::size_t(std::find(steps[0].begin(), steps[0].end(), "residual") - steps[0].begin());
  ASSERT_LT(residual, steps[0].size());
  for (std::size_t k = 1; k < steps.size(); ++k)
    {
      const double of_one = std::stod(std::exchange(steps[k][residual], ""));
      const double of_other = std::stod(std::exchange(other_steps[k][residual], ""));
      EXPECT_NEAR(of_one, of_other, 0.1 * of_one + 1e-7) << "row " << k;
    }
  EXPECT_EQ(steps, other_steps);

  const auto curve = table(one / "curves" / (test_name + ".csv"));
  const auto other_curve = table(other / "curves" / (test_name + ".csv"));
  ASSERT_EQ(curve.size(), other_curve.size());
  for (const std::string name : {"axial_stress_Pa", "mid_stress_Pa", "gauge_lateral_strain", "released_energy_J"})
    {
      const auto column = std::size_t(std::find(curve[0].begin(), curve[0].end(), name) - curve[0].begin());
      ASSERT_LT(column, curve[0].size()) << name;
      double largest = 0.0;
      for (std::size_t k = 1; k < curve.size(); ++k)
        largest = std::max(largest, std::abs(std::stod(curve[k][column])));
      for (std::size_t k = 1; k < curve.size(); ++k)
        EXPECT_NEAR(std::stod(curve[k][column]), std::stod(other_curve[k][column]), 1e-8 * largest)
          << name << " in row " << k;
    }

  // The same RVEs are kept for the report, whichever rank they were on.
  std::vector<std::string> rves, other_rves;
  for (const auto& [run, names] : {std::pair(&one, &rves), {&other, &other_rves}})
    {
      for (const auto& entry : fs::directory_iterator(*run / "points"))
        names->push_back(entry.path().filename().string());
      std::sort(names->begin(), names->end());
    }
  EXPECT_GE(rves.size(), 4u); // grains and cracks of two at least
  ASSERT_EQ(rves, other_rves);
  for (const std::string& name : rves)
    {
      const auto rows = table(one / "points" / name);
      const auto other_rows = table(other / "points" / name);
      ASSERT_EQ(rows.size(), other_rows.size()) << name;
      for (std::size_t k = 1; name.ends_with("_grains.csv") && k < rows.size(); ++k)
        for (std::size_t c = 0; c < 6; ++c) // at rest and as they are
          EXPECT_NEAR(std::stod(rows[k][c]), std::stod(other_rows[k][c]), 1e-10) << name << " line " << k + 1;
    }
}

void expect_success(const Outcome& outcome) { ASSERT_EQ(outcome.exit_code, 0) << outcome.error; }

std::vector<fs::path> checkpoints(const fs::path& run)
{
  std::vector<fs::path> found;
  for (const auto& entry : fs::directory_iterator(run / "states" / test_name))
    found.push_back(entry.path());
  std::sort(found.begin(), found.end());
  return found;
}

/// A shell script that starts a command, waits for so many checkpoints in FOLDER and does something to it; $! is it.
std::string once_there_are_checkpoints(const unsigned int n, const std::string& folder, const std::string& action)
{
  return "\"$@\" &\nuntil [ $(ls -d " + folder + "/states/" + test_name + "/step-* 2>/dev/null | wc -l) -ge " +
         std::to_string(n) + " ]; do sleep 0.02; done\n" + action + "\nwait $!\n";
}

TEST(SeveralRanks, BreakTheSameSegments)
{
  const TemporaryFolder folder;
  folder.write("pull.prm", pull_of_ranks);
  expect_success(run_without_pictures(folder.path(), "multiscale pull.prm --output 1 --quiet --threads 1"));
  expect_success(run_feldspar(folder.path(), "multiscale pull.prm --output 2 --quiet --threads 2", mpirun(2)));
  expect_success(run_feldspar(folder.path(), "multiscale pull.prm --output 4 --quiet --threads 1", mpirun(4)));
  expect_same_run(folder.path() / "1", folder.path() / "2");
  expect_same_run(folder.path() / "1", folder.path() / "4");
  // The sample tears in one row of elements, whose ranks have nearly all the work until some of their cells move.
  const auto ranks_of = [&](const char* run) {
    std::ifstream in(folder.path() / run / "summary.json");
    return nlohmann::json::parse(in)["tests"][0]["ranks"];
  };
  EXPECT_EQ(ranks_of("1")["moves"], 0);
  EXPECT_EQ(ranks_of("1")["longest_s"], ranks_of("1")["mean_s"]);
  for (const char* run : {"2", "4"})
    EXPECT_GE(ranks_of(run)["moves"], 1) << run;
  EXPECT_GT(ranks_of("2")["longest_unmoved_s"].get<double>(), 1.4 * ranks_of("2")["mean_s"].get<double>());
  EXPECT_LT(ranks_of("2")["longest_s"], ranks_of("2")["longest_unmoved_s"]);
  // The last two checkpoints, a part a rank.
  const auto kept = checkpoints(folder.path() / "4");
  ASSERT_EQ(kept.size(), 2u);
  for (const auto& checkpoint : kept)
    EXPECT_EQ(std::distance(fs::directory_iterator(checkpoint), fs::directory_iterator()), 4);
}

TEST(SeveralRanks, BreakTheSameSegmentsOfCylinders)
{
  const TemporaryFolder folder;
  for (const std::string elements : {"  set Geometry = axisymmetric\n  set Elements across = 1\n",
                                     "  set Geometry = cylinder\n  set Elements across = 3\n"})
    {
      // RVEs of some 50 spheres.
      folder.write("pull.prm", "subsection Specimen\n  set Dimension = 3\n  set Shape = periodic\n"
                               "  set Width = 6 mm\n  set Height = 6 mm\nend\n"
                               "subsection Sample\n  set Width = 12 mm\n  set Height = 24 mm\n" +
                                 elements +
                                 "  set Elements along = 2\n  set Realisations = 1\n  set Tension step = 2e-5\n"
                                 "  set Newton tolerance = 1e-10\nend\n"
                                 "subsection Tests\n  set List = direct_tension\n  set Stop strain = 1.6e-4\nend\n"
                                 "subsection Seeds\n  set Seeds = 4\nend\n");
      expect_success(run_without_pictures(folder.path(), "multiscale pull.prm --output 1 --force --quiet --threads 1"));
      expect_success(
        run_feldspar(folder.path(), "multiscale pull.prm --output 2 --force --quiet --threads 1", mpirun(2)));
      expect_same_run(folder.path() / "1", folder.path() / "2", 1);
    }
}

TEST(SeveralRanks, OneThatDiesEndsTheRunWhichIsResumedOnAnyNumber)
{
  const TemporaryFolder folder;
  folder.write("pull.prm", pull_of_ranks);
  expect_success(run_without_pictures(folder.path(), "multiscale pull.prm --output whole --quiet"));
  folder.write("kill", once_there_are_checkpoints(1, "two", "kill -KILL $(pgrep -P $! | head -n 1)"));
  const auto killed = run_feldspar(folder.path(), "multiscale pull.prm --output two --quiet", "sh ./kill " + mpirun(2));
  EXPECT_NE(killed.exit_code, 0);
  EXPECT_NE(killed.error.find("signal 9"), std::string::npos) << killed.error; // mpirun says so
  EXPECT_FALSE(fs::exists(folder.path() / "two/summary.json"));
  fs::copy(folder.path() / "two", folder.path() / "one", fs::copy_options::recursive);
  expect_success(run_without_pictures(folder.path(), "multiscale --resume one --quiet"));
  expect_same_run(folder.path() / "whole", folder.path() / "one");
  expect_success(run_feldspar(folder.path(), "multiscale --resume two --quiet", mpirun(3)));
  expect_same_run(folder.path() / "whole", folder.path() / "two");
}

TEST(SeveralRanks, EndTogetherWhenAsked)
{
  const TemporaryFolder folder;
  folder.write("pull.prm", pull_of_ranks);
  folder.write("ask", once_there_are_checkpoints(1, "out", "kill -USR1 $!")); // which mpirun passes on to all
  const auto asked = run_feldspar(folder.path(), "multiscale pull.prm --output out --quiet", "sh ./ask " + mpirun(2));
  EXPECT_EQ(asked.exit_code, 130) << asked.error;
  EXPECT_NE(asked.error.find("feldspar: interrupted; go on with: feldspar multiscale --resume out\n"),
            std::string::npos)
    << asked.error;
  expect_success(run_without_pictures(folder.path(), "multiscale --resume out --quiet"));
  expect_success(run_without_pictures(folder.path(), "multiscale pull.prm --output whole --quiet"));
  expect_same_run(folder.path() / "whole", folder.path() / "out");
}

TEST(SeveralRanks, SayOnceWhatIsWrong)
{
  const TemporaryFolder folder;
  const auto refused = [&](const std::string& text, const unsigned int n_ranks, const std::string& words) {
    folder.write("bad.prm", text);
    const auto outcome = run_feldspar(folder.path(), "multiscale bad.prm --output out", mpirun(n_ranks));
    EXPECT_EQ(outcome.exit_code, 2) << outcome.error;
    const auto said = outcome.error.find(words);
    EXPECT_NE(said, std::string::npos) << outcome.error;
    EXPECT_EQ(outcome.error.find(words, said + 1), std::string::npos) << outcome.error;
    EXPECT_FALSE(fs::exists(folder.path() / "out"));
  };
  refused(pull_of_ranks + "subsection Sample\n  set Order = 3\nend\n", 2,
          "Sample/Order = 3: must be an integer in [1, 2]");
  std::string three = pull_of_ranks;
  three.replace(three.find("across = 2"), 10, "across = 1");
  three.replace(three.find("along = 4"), 9, "along = 2");
  refused(three, 3, "bad.prm: 3 processes for a sample of 2 cells: each needs one; start at most 2");
  std::string of_file = pull_of_ranks;
  of_file.replace(of_file.find("Realisations = 2"), 16, "Realisations = 1");
  refused(of_file + "subsection Specimen\n  set Specimen file = none.h5\nend\n", 2, "there is no file none.h5");
}

/// Three specimens of some 90 grains, a test each.
const std::string programme = "subsection Specimen\n  set Width = 12 mm\n  set Height = 24 mm\nend\n"
                              "subsection Tests\n  set List = direct_tension\nend\n"
                              "subsection Seeds\n  set Seeds = 1..3\nend\n";

std::string text_of(const fs::path& file)
{
  std::ifstream in(file, std::ios::binary);
  EXPECT_TRUE(in) << file;
  return {std::istreambuf_iterator<char>(in), {}};
}

/// Files of the same names with the same bytes.
void expect_same_files(const fs::path& one, const fs::path& other, const std::string& subfolder, const std::size_t n)
{
  std::size_t n_found = 0;
  for (const auto& entry : fs::directory_iterator(one / subfolder))
    {
      const auto twin = other / subfolder / entry.path().filename();
      ASSERT_TRUE(fs::exists(twin)) << twin;
      EXPECT_TRUE(text_of(entry.path()) == text_of(twin)) << twin;
      ++n_found;
    }
  EXPECT_EQ(n_found, n);
}

// Ranks take whole tests, each of which has its bits whoever makes it.
TEST(SeveralRanks, OfTheLaboratoryHaveTheBitsOfOne)
{
  const TemporaryFolder folder;
  folder.write("rock.prm", programme);
  expect_success(run_without_pictures(folder.path(), "lab rock.prm --output one --quiet"));
  expect_success(run_feldspar(folder.path(), "lab rock.prm --output two --quiet --threads 1", mpirun(2)));
  expect_same_files(folder.path() / "one", folder.path() / "two", "curves", 3);
  expect_same_files(folder.path() / "one", folder.path() / "two", "grains", 3);
  for (const std::string file : {"cracks.csv", "emission.csv"})
    EXPECT_TRUE(text_of(folder.path() / "one" / file) == text_of(folder.path() / "two" / file)) << file;
  EXPECT_FALSE(fs::exists(folder.path() / "two/checkpoints"));

  // Asked to end, all end; one process resumes what they left.
  folder.write("ask", "\"$@\" &\nuntil ls out/checkpoints/*.h5 >/dev/null 2>&1; do sleep 0.02; done\n"
                      "kill -USR1 $!\nwait $!\n");
  const auto asked =
    run_feldspar(folder.path(), "lab rock.prm --output out --quiet --threads 1", "sh ./ask " + mpirun(2));
  EXPECT_EQ(asked.exit_code, 130) << asked.error;
  EXPECT_NE(asked.error.find("feldspar: interrupted; go on with: feldspar lab --resume out\n"), std::string::npos)
    << asked.error;
  expect_success(run_without_pictures(folder.path(), "lab --resume out --quiet"));
  expect_same_files(folder.path() / "one", folder.path() / "out", "curves", 3);

  // An error is said once, and leaves nothing.
  const auto wrong =
    run_feldspar(folder.path(), "lab rock.prm --output bad --set 'Specimen/Width = 0.1 mm'", mpirun(2));
  EXPECT_EQ(wrong.exit_code, 2) << wrong.error;
  EXPECT_EQ(wrong.error.find("feldspar: "), wrong.error.rfind("feldspar: ")) << wrong.error;
  EXPECT_FALSE(fs::exists(folder.path() / "bad"));
}

TEST(SeveralRanks, TakePathsOfCells)
{
  const TemporaryFolder folder;
  folder.write("path.csv", "strain_xx,strain_yy,strain_xy\n0,0,0\n0,2e-4,0\n");
  folder.write("cell.prm", "subsection Specimen\n  set Shape = periodic\n  set Width = 12 mm\n  set Height = 12 mm\n"
                           "end\nsubsection Strain path\n  set File = path.csv\nend\n"
                           "subsection Seeds\n  set Seeds = 1..3\nend\n");
  expect_success(run_feldspar(folder.path(), "rve cell.prm --output one --quiet"));
  expect_success(run_feldspar(folder.path(), "rve cell.prm --output two --quiet --threads 1", mpirun(2)));
  expect_same_files(folder.path() / "one", folder.path() / "two", "curves", 3);
}

/// The batch script of docs/cluster.md: a job that is told that its time ends writes a checkpoint and hands on to the next.
TEST(SeveralRanks, FollowEachOtherUnderSlurm)
{
  if (geteuid() != 0 || !fs::exists("/usr/sbin/slurmctld"))
    GTEST_SKIP() << "needs root and the package slurm-wlm";
  const TemporaryFolder folder;
  std::string slow = pull_of_ranks;
  slow.replace(slow.find("step = 1e-5"), 11, "step = 3e-7");
  folder.write("pull.prm", slow);
  const auto trial =
    tests::run_command(folder.path(), "OMPI_MCA_mpi_yield_when_idle=1 '" FELDSPAR_SOURCE_DIR
                                      "/scripts/slurm-trial.sh' '" FELDSPAR_COMMAND "' pull.prm slurm");
  if (trial.exit_code == 77)
    GTEST_SKIP() << "Slurm does not come up here: " << trial.output;
  ASSERT_EQ(trial.exit_code, 0) << trial.output << trial.error;
  EXPECT_NE(trial.output.find("Exited with exit code 130"), std::string::npos) << trial.output;
  EXPECT_NE(trial.output.find("JobId=2"), std::string::npos) << trial.output;
  expect_success(run_without_pictures(folder.path(), "multiscale pull.prm --output whole --quiet"));
  expect_same_run(folder.path() / "whole", folder.path() / "slurm/RUN");
}

TEST(Checkpoints, OneThatIsDamagedIsRefusedAndTheOneBeforeItUsed)
{
  const TemporaryFolder folder;
  folder.write("pull.prm", pull_of_ranks);
  expect_success(run_without_pictures(folder.path(), "multiscale pull.prm --output whole --quiet"));
  folder.write("kill", once_there_are_checkpoints(2, "broken", "kill -KILL $!"));
  run_feldspar(folder.path(), "multiscale pull.prm --output broken --quiet", "sh ./kill");
  const auto kept = checkpoints(folder.path() / "broken");
  ASSERT_GE(kept.size(), 2u);
  const std::string last = "broken/states/" + test_name + "/" + kept[1].filename().string() + "/part-00000.h5";
  const auto resumed = [&](const std::string& name, const auto& damage, const std::string& words) {
    fs::copy(folder.path() / "broken", folder.path() / name, fs::copy_options::recursive);
    std::string file = last;
    file.replace(0, 6, name);
    damage(folder.path() / file);
    const auto outcome = run_without_pictures(folder.path(), "multiscale --resume " + name + " --quiet");
    EXPECT_EQ(outcome.exit_code, 0) << outcome.error;
    EXPECT_NE(outcome.error.find(file + ": " + words), std::string::npos) << outcome.error;
    EXPECT_NE(outcome.error.find("going back to the checkpoint before it\n"), std::string::npos) << outcome.error;
    EXPECT_EQ(std::count(outcome.error.begin(), outcome.error.end(), '\n'), 1) << outcome.error;
    expect_same_run(folder.path() / "whole", folder.path() / name);
  };
  resumed(
    "torn", [](const fs::path& file) { fs::resize_file(file, fs::file_size(file) / 2); }, "damaged or cut short");
  resumed(
    "missing", [](const fs::path& file) { fs::remove(file); }, "cannot be read: No such file");
  std::string other = pull_of_ranks;
  other.replace(other.find("2.2e-4"), 6, "2e-5  ");
  folder.write("other.prm", other);
  expect_success(run_without_pictures(folder.path(), "multiscale other.prm --output other --quiet"));
  resumed(
    "foreign",
    [&](const fs::path& file) {
      fs::copy_file(checkpoints(folder.path() / "other").back() / "part-00000.h5", file,
                    fs::copy_options::overwrite_existing);
    },
    "of another test, input or version of this program");
}

TEST(Checkpoints, AFullDiskLeavesTheOneBeforeAndSaysSo)
{
  const TemporaryFolder folder;
  folder.write("pull.prm", pull_of_ranks);
  // Files of more than 28 kB cannot be written from some moment on; a checkpoint of this sample has more than 30.
  folder.write("fill", "trap '' XFSZ\n" + once_there_are_checkpoints(1, "out", "prlimit --pid $! --fsize=28000"));
  const auto full = run_feldspar(folder.path(), "multiscale pull.prm --output out --quiet --threads 1", "sh ./fill");
  EXPECT_EQ(full.exit_code, 3) << full.error;
  const auto kept = checkpoints(folder.path() / "out");
  ASSERT_FALSE(kept.empty());
  EXPECT_NE(full.error.find("cannot be written: File too large; what is kept is out/states/" + test_name + "/" +
                            kept.back().filename().string() +
                            "; once it can, go on with: feldspar multiscale --resume out\n"),
            std::string::npos)
    << full.error;
  EXPECT_FALSE(fs::exists(folder.path() / "out/states" / test_name / "unfinished"));
  expect_success(run_without_pictures(folder.path(), "multiscale --resume out --quiet"));
  expect_success(run_without_pictures(folder.path(), "multiscale pull.prm --output whole --quiet"));
  expect_same_run(folder.path() / "whole", folder.path() / "out");
}
} // namespace
} // namespace feldspar

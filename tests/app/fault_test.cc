#include "tests/app/run_command.h"
#include "tests/temporary_folder.h"

#include <fmt/format.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <string>

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

std::size_t n_lines(const std::string& text) { return std::size_t(std::count(text.begin(), text.end(), '\n')); }

std::string content(const fs::path& file)
{
  std::ifstream in(file, std::ios::binary);
  return {std::istreambuf_iterator<char>(in), {}};
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
  ASSERT_EQ(run_feldspar(folder.path(), "lab rock.prm --output whole --quiet").exit_code, 0);
  int n_met = 0;
  for (const int n_writes : {0, 1, 2, 4, 6, 8, 12})
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
      if (n_writes == 4 || n_writes == 12)
        {
          EXPECT_EQ(run_feldspar(folder.path(), "lab --resume " + out + " --quiet").exit_code, 0) << n_writes;
          EXPECT_EQ(content(folder.path() / out / "curves/direct_tension_seed_1.csv"),
                    content(folder.path() / "whole/curves/direct_tension_seed_1.csv"));
        }
    }
  EXPECT_GE(n_met, 4);
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
  ASSERT_EQ(run_feldspar(folder.path(), "lab rock.prm --output whole --quiet").exit_code, 0);
  const auto same = [&](const std::string& out) {
    for (const char* file : {"curves/direct_tension_seed_1.csv", "cracks.csv"})
      EXPECT_EQ(content(folder.path() / out / file), content(folder.path() / "whole" / file)) << out << "/" << file;
    EXPECT_TRUE(nlohmann::json::accept(content(folder.path() / out / "summary.json"))) << out;
    EXPECT_TRUE(nlohmann::json::parse(content(folder.path() / out / "run.json"))["complete"].get<bool>()) << out;
  };
  // Closed: its number must not go to the first file that is opened.
  EXPECT_EQ(run_feldspar(folder.path(), "lab rock.prm --output closed >&- 2>&- <&-").exit_code, 0);
  same("closed");
  const auto full = run_feldspar(folder.path(), "lab rock.prm --output full --quiet > /dev/full");
  EXPECT_EQ(full.exit_code, 3);
  EXPECT_EQ(n_lines(full.error), 1u) << full.error;
  EXPECT_NE(full.error.find("standard output"), std::string::npos) << full.error;
  same("full");
  // Who reads along goes away.
  run_feldspar(folder.path(), "lab rock.prm --output left | head -c 1");
  same("left");
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
                        " lab rock.prm --output out --force --quiet; echo $?\nkill -TERM $!\nwait $!\n");
  const auto outcome = run_feldspar(folder.path(), "lab rock.prm --output out --quiet", "timeout 20 sh ./two");
  EXPECT_EQ(outcome.exit_code, 130);
  EXPECT_EQ(outcome.output, "2\n2\nout\n");
  const std::string refusal = "feldspar: out: another feldspar works in this folder; ";
  EXPECT_EQ(outcome.error.find(refusal), 0u) << outcome.error;
  EXPECT_NE(outcome.error.find(refusal, 1), std::string::npos) << outcome.error;
  EXPECT_TRUE(fs::exists(folder.path() / "out/run.json"));
}

TEST(Fault, NeedsNoHomeAndNoFolderForTemporaryFiles)
{
  const TemporaryFolder folder;
  folder.write("rock.prm", quick_rock);
  const auto outcome = run_feldspar(folder.path(), "lab rock.prm --output out --quiet",
                                    "env --unset=HOME --unset=USER TMPDIR=/nowhere TMP=/nowhere");
  EXPECT_EQ(outcome.exit_code, 0) << outcome.error;
  EXPECT_EQ(outcome.error, "");
  EXPECT_TRUE(fs::exists(folder.path() / "out/figures/overview.png"));
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

#include "tests/app/run_command.h"
#include "tests/content.h"
#include "tests/temporary_folder.h"

#include <gtest/gtest.h>

#include <filesystem>
#include <string>

/// `mpirun feldspar lab` with one body that all processes compute together.
namespace feldspar
{
namespace
{
namespace fs = std::filesystem;
using tests::mpirun;
using tests::run_feldspar;
using tests::run_without_pictures;
using tests::TemporaryFolder;

/// Some 200 grains.
const std::string granite = "subsection Specimen\n  set Width = 16 mm\n  set Height = 32 mm\nend\n"
                            "subsection Tests\n  set List = direct_tension, uniaxial_compression\n"
                            "  set Steps between checkpoints = 2000\n  set Shared body = always\nend\n";

void expect_same_bytes(const fs::path& one, const fs::path& other)
{
  for (const std::string file :
       {"cracks.csv", "emission.csv", "curves/direct_tension_seed_1.csv", "curves/uniaxial_compression_seed_1.csv",
        "grains/direct_tension_seed_1.csv", "grains/uniaxial_compression_seed_1.csv"})
    {
      const std::string content = tests::content(one / file);
      EXPECT_GT(content.size(), 500u) << file;
      EXPECT_TRUE(content == tests::content(other / file)) << file << " of " << other;
    }
}

TEST(SeveralRanks, ThatShareABodyHaveTheBytesOfOneProcessAlsoKilledAndResumedOnAnotherNumber)
{
  const TemporaryFolder folder;
  folder.write("granite.prm", granite);
  const auto expect_success = [](const tests::Outcome& outcome) { EXPECT_EQ(outcome.exit_code, 0) << outcome.error; };
  expect_success(run_without_pictures(folder.path(), "lab granite.prm --output 1 --quiet"));
  const auto of_four = run_feldspar(folder.path(), "lab granite.prm --output 4 --threads 1", mpirun(4));
  expect_success(of_four);
  EXPECT_EQ(of_four.error.find("2 tests of some "), of_four.error.rfind("2 tests of some "))
    << "the first rank says it";
  EXPECT_NE(of_four.error.find(" steps by 4 processes together: about "), std::string::npos) << of_four.error;
  expect_same_bytes(folder.path() / "1", folder.path() / "4");

  // Killed in compression, which is the longer test and comes first.
  folder.write("kill",
               "\"$@\" &\nuntil [ -e 3/checkpoints/uniaxial_compression_seed_1.previous.h5 ]; do sleep 0.02; done\n"
               "kill -KILL $(pgrep -P $! | tail -n 1)\nwait $!\n");
  const auto killed =
    run_feldspar(folder.path(), "lab granite.prm --output 3 --quiet --threads 1", "sh ./kill " + mpirun(3));
  EXPECT_NE(killed.exit_code, 0);
  EXPECT_FALSE(fs::exists(folder.path() / "3/summary.json"));
  expect_success(run_feldspar(folder.path(), "lab --resume 3 --quiet --threads 2", mpirun(2)));
  expect_same_bytes(folder.path() / "1", folder.path() / "3");
}

TEST(SeveralRanks, ThatShareABodyEndTogetherWhenAsked)
{
  const TemporaryFolder folder;
  folder.write("granite.prm", granite);
  folder.write("ask", "\"$@\" &\nuntil [ -e out/checkpoints/uniaxial_compression_seed_1.h5 ]; do sleep 0.02; done\n"
                      "kill -USR1 $!\nwait $!\n"); // which mpirun passes on to all
  const auto asked =
    run_feldspar(folder.path(), "lab granite.prm --output out --quiet --threads 1", "sh ./ask " + mpirun(2));
  EXPECT_EQ(asked.exit_code, 130) << asked.error;
  EXPECT_NE(asked.error.find("feldspar: interrupted; go on with: feldspar lab --resume out\n"), std::string::npos)
    << asked.error;
}
} // namespace
} // namespace feldspar

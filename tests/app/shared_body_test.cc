#include "tests/app/result_files.h"
#include "tests/app/run_command.h"
#include "tests/temporary_folder.h"

#include <gtest/gtest.h>

#include <filesystem>
#include <string>
#include <vector>

/// `mpirun feldspar lab` with one body that all processes compute together.
namespace feldspar::tests
{
namespace
{
namespace fs = std::filesystem;

/// Some 200 grains.
const std::string granite = section("Specimen", "Width = 16 mm", "Height = 32 mm") +
                            section("Tests", "List = direct_tension, uniaxial_compression",
                                    "Steps between checkpoints = 2000", "Shared body = always");

const std::vector<std::string> of_both_tests{"cracks.csv",
                                             "emission.csv",
                                             "curves/direct_tension_seed_1.csv",
                                             "curves/uniaxial_compression_seed_1.csv",
                                             "grains/direct_tension_seed_1.csv",
                                             "grains/uniaxial_compression_seed_1.csv"};

TEST(SeveralRanks, ThatShareABodyHaveTheBytesOfOneProcessAlsoKilledAndResumedOnAnotherNumber)
{
  const TemporaryFolder folder;
  folder.write("granite.prm", granite);
  run_to_end(folder, "lab granite.prm --output 1 --quiet");
  for (const std::string& file : of_both_tests)
    EXPECT_GT(content(folder / "1" / file).size(), 500u) << file;
  const auto of_four = run_to_end(folder, "lab granite.prm --output 4 --threads 1", mpirun(4));
  EXPECT_EQ(of_four.error.find("2 tests of some "), of_four.error.rfind("2 tests of some "))
    << "the first rank says it";
  EXPECT_TRUE(has_words(of_four.error, " steps by 4 processes together: about "));
  expect_same_files(folder / "1", folder / "4", of_both_tests);

  // Killed in compression, which is the longer test and comes first.
  const auto killed = run_until(folder, "lab granite.prm --output 3 --quiet --threads 1",
                                "[ -e 3/checkpoints/uniaxial_compression_seed_1.previous.h5 ]",
                                "kill -KILL $(pgrep -P $! | tail -n 1)", mpirun(3));
  EXPECT_NE(killed.exit_code, 0);
  EXPECT_FALSE(fs::exists(folder / "3/summary.json"));
  run_to_end(folder, "lab --resume 3 --quiet --threads 2", mpirun(2));
  expect_same_files(folder / "1", folder / "3", of_both_tests);
}

TEST(SeveralRanks, ThatShareABodyEndTogetherWhenAsked)
{
  const TemporaryFolder folder;
  folder.write("granite.prm", granite);
  const auto asked = run_until(folder, "lab granite.prm --output out --quiet --threads 1",
                               "[ -e out/checkpoints/uniaxial_compression_seed_1.h5 ]", "kill -USR1 $!",
                               mpirun(2)); // which passes it on to all
  EXPECT_EQ(asked.exit_code, 130) << asked.error;
  EXPECT_TRUE(has_words(asked.error, "feldspar: interrupted; go on with: feldspar lab --resume out\n"));
}
} // namespace
} // namespace feldspar::tests

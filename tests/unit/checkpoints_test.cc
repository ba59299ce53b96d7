#include "base/whole_file.h"
#include "coupling/sample/checkpoints.h"
#include "tests/temporary_folder.h"
#include "tests/words.h"

#include <gtest/gtest.h>
#include <sys/resource.h>

#include <csignal>
#include <fstream>

namespace feldspar
{
namespace
{
using tests::has;
using tests::TemporaryFolder;

void write(const TemporaryFolder& folder, const std::uint64_t step, const std::size_t n)
{
  write_checkpoint(folder.path(), step, "mine", [&](Hdf5Writer& root) {
    std::vector<double> values(n, double(step));
    root.array("values", values);
  });
}

/// The step that a checkpoint holds.
double read(const std::filesystem::path& checkpoint, const std::string& identity = "mine")
{
  double step = 0.0;
  read_checkpoint(checkpoint, identity, [&](Hdf5Reader& root, std::uint64_t) {
    std::vector<double> values;
    root.array("values", values);
    step = values.front();
  });
  return step;
}

std::vector<std::string> names(const TemporaryFolder& folder)
{
  std::vector<std::string> all;
  for (const auto& checkpoint : checkpoints_in(folder.path()))
    all.push_back(checkpoint.filename().string());
  return all;
}

using Names = std::vector<std::string>;

std::string refusal(const std::filesystem::path& checkpoint, const std::string& identity = "mine")
{
  return tests::refusal([&] { read(checkpoint, identity); });
}

TEST(Checkpoints, TheLastTwoAreKept)
{
  const TemporaryFolder folder;
  EXPECT_EQ(names(folder), Names{});
  for (const std::uint64_t step : {8, 9, 10})
    write(folder, step, 100);
  EXPECT_EQ(names(folder), (Names{"step-0000000010", "step-0000000009"}));
  EXPECT_EQ(read(folder.path() / "step-0000000009"), 9.0);
  // A run that went back to an earlier step has no use for later ones.
  write(folder, 7, 100);
  EXPECT_EQ(names(folder), Names{"step-0000000007"});
  write(folder, 7, 200); // again, as when a test ends
  EXPECT_EQ(names(folder), Names{"step-0000000007"});
}

TEST(Checkpoints, AreRefusedWhereTheyCannotBeTrusted)
{
  const TemporaryFolder folder;
  write(folder, 1, 10000);
  const auto checkpoint = folder.path() / "step-0000000001";
  const auto part = checkpoint / "part-00000.h5";
  EXPECT_EQ(refusal(checkpoint, "another"), part.string() +
                                              ": of another test, input or version of this program; a checkpoint of "
                                              "Feldspar is expected");
  // Torn at any of some places.
  const auto size = std::filesystem::file_size(part);
  for (const auto left : {size - 1, size / 2, size / 10, std::uintmax_t(0)})
    {
      std::filesystem::resize_file(part, left);
      EXPECT_TRUE(has(refusal(checkpoint), "damaged or cut short")) << left;
    }
  // A byte that a disk changed, in the middle of the values.
  write(folder, 2, 10000);
  const auto other = folder.path() / "step-0000000002" / "part-00000.h5";
  std::fstream file(other, std::ios::in | std::ios::out | std::ios::binary);
  file.seekp(std::streamoff(std::filesystem::file_size(other) / 2));
  file.put('\x55');
  file.close();
  EXPECT_NE(refusal(folder.path() / "step-0000000002"), "");
  std::filesystem::remove(other);
  EXPECT_TRUE(has(refusal(folder.path() / "step-0000000002"), "No such file"));
}

TEST(Checkpoints, AFullDiskLeavesTheOneBefore)
{
  const TemporaryFolder folder;
  write(folder, 1, 100);
  std::signal(SIGXFSZ, SIG_IGN);
  rlimit before{};
  getrlimit(RLIMIT_FSIZE, &before);
  rlimit low = before;
  low.rlim_cur = 50000; // bytes
  setrlimit(RLIMIT_FSIZE, &low);
  const std::string said = tests::refusal<OutputError>([&] { write(folder, 2, 10000); }); // 80 kB
  setrlimit(RLIMIT_FSIZE, &before);
  EXPECT_TRUE(has(said, "part-00000.h5: cannot be written: File too large; what is kept is " +
                          (folder.path() / "step-0000000001").string()));
  EXPECT_EQ(names(folder), Names{"step-0000000001"});
  EXPECT_EQ(read(folder.path() / "step-0000000001"), 1.0);
  EXPECT_FALSE(std::filesystem::exists(folder.path() / "unfinished")); // which would keep the disk full
}
} // namespace
} // namespace feldspar

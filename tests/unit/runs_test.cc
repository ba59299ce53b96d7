#include "runs/laboratory.h"

#include "base/whole_file.h"
#include "dem/lab/protocols/protocols.h"
#include "runs/checkpoints.h"
#include "tests/temporary_folder.h"
#include "tests/unit/same_bits.h"
#include "tests/unit/small_specimen.h"
#include "tests/words.h"

#include <gtest/gtest.h>

#include <atomic>
#include <filesystem>
#include <fstream>
#include <string>

/// Runs without a screen, a command line or an input file.
namespace feldspar
{
namespace
{
using tests::has;

namespace fs = std::filesystem;
using tests::TemporaryFolder;

/// Wants the end once a test has got so many rows.
class Patience : public RunObserver
{
public:
  explicit Patience(const std::size_t most_rows)
    : most(most_rows)
  {
  }

  bool wants_end() const override { return n_rows >= most; }
  void advanced(const std::size_t /*part*/, const PartStanding& standing) override
  {
    ASSERT_NE(standing.row, nullptr);
    ++n_rows;
  }
  void ended(const std::size_t /*part*/) override { ++n_ended; }
  void cannot_be_made(const std::size_t part, const std::string& reason) override
  {
    failed = part;
    why = reason;
  }

  void goes_back(const std::string& sentence) override { back = sentence; }

  const std::size_t most;
  std::atomic<std::size_t> n_rows = 0;
  std::atomic<std::size_t> n_ended = 0;
  std::size_t failed = 99;
  std::string why;
  std::string back;
};

constexpr std::size_t all_rows = 1000000;

LaboratoryOrder order_of(const TestParameters& parameters, const std::string& name,
                         const TestCase& test_case = {uniaxial_compression.kind})
{
  static const DynamicsParameters dynamics;
  LaboratoryOrder order{test_case, &parameters, &dynamics};
  order.name = name;
  return order;
}

Specimen<2> again(const std::size_t /*number*/) { return small_specimen(1, 0.2); }

std::vector<FinishedTest> run(const std::vector<LaboratoryOrder>& orders, const TemporaryFolder& folder,
                              RunObserver& observer)
{
  std::vector specimens{small_specimen(1, 0.2)};
  return run_tests<2>(orders, specimens, again, folder.path(), observer);
}

// The end that an observer wants leaves a test that a later run takes up at the row where it stood, to the same bits.
TEST(Runs, AnObserverEndsALaboratoryRunAndALaterOneGoesOnToTheSameBits)
{
  const TestParameters parameters = quick_compression();
  LaboratoryOrder order = order_of(parameters, "compression");
  order.identity = "this test";

  const TemporaryFolder at_once;
  Patience patient(all_rows);
  const auto whole = run({order}, at_once, patient);
  ASSERT_EQ(whole.size(), 1u);
  EXPECT_TRUE(whole.front().was_made());
  constexpr std::size_t at_rest = 1; // the first advance gives the row of the seating and the next
  EXPECT_EQ(patient.n_rows + at_rest, whole.front().record.curve.size());
  EXPECT_EQ(patient.n_ended, 1u);

  const TemporaryFolder in_parts;
  constexpr std::size_t n_before = 7;
  Patience impatient(n_before);
  const auto begun = run({order}, in_parts, impatient);
  ASSERT_EQ(begun.size(), 1u);
  EXPECT_TRUE(begun.front().record.interrupted);
  EXPECT_EQ(begun.front().record.curve.size(), n_before + at_rest);
  Patience resumed(all_rows);
  const auto ended = run({order}, in_parts, resumed);
  EXPECT_EQ(resumed.n_rows, patient.n_rows - n_before);
  tests::expect_same_bits({whole.front().record, whole.front().appearance, {}},
                          {ended.front().record, ended.front().appearance, {}});

  EXPECT_EQ(resumed.back, "");
  in_parts.write("checkpoints/compression.h5", "torn");
  Patience nothing_torn(all_rows);
  EXPECT_EQ(run({order}, in_parts, nothing_torn).front().record.curve.size(), patient.n_rows + at_rest);
  EXPECT_TRUE(has(nothing_torn.back, "compression.h5: "));
  EXPECT_TRUE(nothing_torn.back.ends_with("; going back to the checkpoint before it")) << nothing_torn.back;

  Patience nothing_left(all_rows);
  EXPECT_EQ(run({order}, in_parts, nothing_left).front().record.curve.size(), patient.n_rows + at_rest);
  EXPECT_EQ(nothing_left.n_rows, 0u);
}

/// A part of a run whose state is a word, which cannot be written where the disk is full.
struct Word
{
  void write_checkpoint(const fs::path& file, const std::string& /*identity*/) const
  {
    if (disk_is_full)
      throw OutputError("no space");
    std::ofstream(file) << word;
  }
  void read_checkpoint(const fs::path& file, const std::string& /*identity*/)
  {
    std::ifstream(file) >> word;
    if (word == "torn")
      throw InputError("torn");
  }

  std::string word;
  bool disk_is_full = false;
};

TEST(Checkpoints, ATornOneDoesNotTakeThePlaceOfTheGoodOne)
{
  const TemporaryFolder folder;
  const Checkpoints checkpoints(folder.path(), "word", "it");
  const auto open = [&] { return checkpoints.open([] { return Word{"begun"}; }, [](const std::string&) {}); };
  for (const std::string word : {"good", "torn"})
    checkpoints.write(Word{word});
  Word resumed = open();
  EXPECT_EQ(resumed.word, "good");
  resumed.disk_is_full = true;
  EXPECT_THROW(checkpoints.write(resumed), OutputError);
  EXPECT_EQ(open().word, "good");
}

// The last test of a specimen takes its grains: the others have had copies, so that each comes to the bits of a test alone.
TEST(Runs, TheLastTestOfASpecimenTakesItsGrains)
{
  TestParameters parameters = quick_compression();
  parameters.stop_strain = 5e-4;
  std::vector<LaboratoryOrder> orders;
  for (const char* const name : {"compression_0", "compression_1", "compression_2"})
    orders.push_back(order_of(parameters, name));

  const TemporaryFolder folder, folder_of_one;
  Patience patient(all_rows), patient_with_one(all_rows);
  std::vector specimens{small_specimen(1, 0.2)}, one{small_specimen(1, 0.2)};
  const auto tests = run_tests<2>(orders, specimens, again, folder.path(), patient);
  const auto alone = run_tests<2>({orders.front()}, one, again, folder_of_one.path(), patient_with_one);
  ASSERT_EQ(tests.size(), orders.size());
  for (const FinishedTest& test : tests)
    tests::expect_same_bits({alone.front().record, alone.front().appearance, {}}, {test.record, test.appearance, {}});
  for (const auto& tested : {specimens.front(), one.front()})
    {
      EXPECT_EQ(tested.grains.size(), 0u);
      EXPECT_EQ(tested.joints.size(), 0u);
      EXPECT_EQ(tested.seed, 1u);
      EXPECT_GT(tested.report.coordination_number, 1.0) << "what a run reports of it stays";
    }
}

// Tests that had not begun when the end was wanted are not in the results.
TEST(Runs, WhereTheEndIsWantedNoTestBegins)
{
  const TestParameters parameters = quick_compression();
  const LaboratoryOrder order = order_of(parameters, "");
  const TemporaryFolder folder;
  Patience none(0);
  EXPECT_TRUE(run({order, order}, folder, none).empty());
  EXPECT_EQ(none.n_ended, 0u);
}

// One thousand GPa press these grains farther than any servo follows; the other test is made all the same.
TEST(Runs, OneTestThatCannotBeMadeDoesNotCostTheOthers)
{
  TestParameters parameters = quick_compression();
  parameters.stop_strain = 5e-4;
  const LaboratoryOrder good = order_of(parameters, "good");
  const LaboratoryOrder bad = order_of(parameters, "bad", {triaxial_compression.kind, 1e12});
  const TemporaryFolder folder;
  Patience patient(all_rows);
  const auto tests = run({bad, good}, folder, patient);
  ASSERT_EQ(tests.size(), 2u);
  EXPECT_EQ(patient.failed, 0u);
  EXPECT_EQ(tests[0].record.failure, patient.why);
  EXPECT_FALSE(patient.why.empty());
  EXPECT_TRUE(tests[1].was_made());
}
} // namespace
} // namespace feldspar

#include "fem/solid/material_points.h"
#include "fem/solid/step_control.h"

#include <gtest/gtest.h>
#include <oneapi/tbb/global_control.h>
#include <oneapi/tbb/task_arena.h>

#include <atomic>
#include <chrono>
#include <thread>

namespace feldspar::fem
{
TEST(StepControl, GoesItsWayInEqualStepsWhereNothingFails)
{
  StepControl steps(0.25, 0.01, 0.25);
  for (const double end : {0.25, 0.5, 0.75, 1.0})
    {
      EXPECT_DOUBLE_EQ(steps.next(), end);
      EXPECT_FALSE(steps.finished());
      steps.succeeded();
    }
  EXPECT_TRUE(steps.finished());
}

TEST(StepControl, HalvesWhatFailsAndGrowsAfterTwoSuccesses)
{
  StepControl steps(0.16, 0.01, 0.16);
  EXPECT_TRUE(steps.cut());
  EXPECT_TRUE(steps.cut());
  EXPECT_DOUBLE_EQ(steps.next(), 0.04);
  steps.succeeded();
  EXPECT_DOUBLE_EQ(steps.next(), 0.08);
  steps.succeeded();
  EXPECT_DOUBLE_EQ(steps.next(), 0.08 + 0.06);
  for (int i = 0; i < 5; ++i)
    {
      const double before = steps.done();
      steps.succeeded();
      EXPECT_LE(steps.done() - before, 0.16 + 1e-12); // no larger than asked
    }
}

TEST(StepControl, GivesUpBelowTheSmallestStepWhereItStands)
{
  StepControl steps(0.5, 0.1, 0.5);
  steps.succeeded();
  EXPECT_TRUE(steps.cut());              // 0.25
  EXPECT_TRUE(steps.cut());              // 0.125
  EXPECT_FALSE(steps.cut());             // 0.0625
  EXPECT_DOUBLE_EQ(steps.next(), 0.625); // as it was: not even smaller
  EXPECT_DOUBLE_EQ(steps.done(), 0.5);
}

TEST(StepControl, LeavesNoSliverAtTheEnd)
{
  StepControl steps(0.3, 0.01, 0.3);
  double smallest = 1.0;
  while (!steps.finished())
    {
      const double before = steps.done();
      steps.succeeded();
      smallest = std::min(smallest, steps.done() - before);
    }
  EXPECT_GE(smallest, 0.15); // 0.3 0.3 0.2 0.2, not 0.3 0.3 0.3 0.1
}

namespace
{
/// A point whose response waits until another thread is responding too.
class WaitingPoint : public MaterialPoint<2>
{
public:
  explicit WaitingPoint(std::atomic<int>& its_n_present)
    : n_present(its_n_present)
  {
  }

  MaterialResponse<2> trial(const StrainVector<2>&) const override
  {
    ++n_present;
    const auto end = std::chrono::steady_clock::now() + std::chrono::seconds(20);
    while (n_present < 2)
      {
        if (std::chrono::steady_clock::now() > end)
          throw PointFailure("alone");
        std::this_thread::yield();
      }
    return {StressVector<2>::Zero(), StiffnessMatrix<2>::Zero()};
  }

private:
  std::atomic<int>& n_present;
};
} // namespace

TEST(MaterialPoints, OfOneRankAreWorkedOnByTwoThreadsUnderMPI)
{
  // Two workers also on one core; a smaller limit set elsewhere would win over this one.
  using oneapi::tbb::global_control;
  const global_control two_workers(global_control::max_allowed_parallelism, 2);
  oneapi::tbb::task_arena two(2);
  std::atomic<int> n_present = 0;
  MaterialPoints<2> points;
  for (int i = 0; i < 2; ++i)
    points.add(std::make_unique<WaitingPoint>(n_present));
  // With one worker the first point waits for ever: so it is under MPI_InitFinalize(argc, argv, 1).
  EXPECT_NO_THROW(two.execute([&] { points.trial({StrainVector<2>::Zero(), StrainVector<2>::Zero()}); }));
}
} // namespace feldspar::fem

// The verdict on a target: what it says of means, intervals and packings, and how often it is wrong on known scatter.

#include "base/random.h"
#include "calibration/target_outcomes.h"
#include "results/statistics.h"
#include "results/target_verdict.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

namespace feldspar::calibration
{
namespace
{
/// A target of 100, and specimens that gave these values.
TargetOutcome outcome_of_values(const std::vector<double>& values)
{
  return {{0, 100.0, 3.0, ""}, statistics(values), 100.0};
}

TargetVerdict verdict_on_values(const std::vector<double>& values)
{
  return verdict_on(outcome_of_values(values), 0.03);
}

TEST(TargetVerdict, FollowsTheWholeIntervalOfTheMean)
{
  // Student's factor of four values is 3.182. The standard error of 101 ± d, two each, is d / √3.
  const auto about_101 = [](const double half_width) {
    const double d = half_width * std::sqrt(3.0) / 3.182446;
    return std::vector<double>{101.0 - d, 101.0 - d, 101.0 + d, 101.0 + d};
  };
  EXPECT_EQ(verdict_on_values(about_101(1.99)), TargetVerdict::reached);
  EXPECT_EQ(verdict_on_values(about_101(2.01)), TargetVerdict::not_decided) << "98.99 to 103.01";
  // Two specimens: the factor is 12.71, the standard error half of their difference.
  EXPECT_EQ(verdict_on_values({104.9, 105.1}), TargetVerdict::missed) << "103.7 to 106.3";
  EXPECT_EQ(verdict_on_values({104.8, 105.2}), TargetVerdict::not_decided) << "102.5 to 107.5";
  EXPECT_EQ(verdict_on_values({95.1, 94.9}), TargetVerdict::missed);
  EXPECT_EQ(verdict_on_values({100.0}), TargetVerdict::not_decided) << "one specimen tells no scatter";
  const TargetOutcome untested{{0, 100.0, 3.0, ""}, std::nullopt, 100.0};
  EXPECT_EQ(verdict_on(untested, 0.03), TargetVerdict::not_decided) << "a prediction is no test";
}

// Two standard errors of six packings let these pass, and the next three packings were 44 % off.
TEST(TargetVerdict, IsNotReachedByScatter)
{
  EXPECT_EQ(verdict_on(TargetMean{"", -0.18, 0.10, 6}, 0.05), TargetVerdict::not_decided);
  EXPECT_EQ(verdict_on(TargetMean{"", 0.13, 0.08, 6}, 0.05), TargetVerdict::not_decided);
  EXPECT_EQ(verdict_on(TargetMean{"", 0.00, 0.08, 6}, 0.05), TargetVerdict::not_decided) << "by chance";
  EXPECT_EQ(verdict_on(TargetMean{"", -0.18, 0.02, 6}, 0.05), TargetVerdict::missed);
  const double infinity = std::numeric_limits<double>::infinity();
  EXPECT_EQ(verdict_on(TargetMean{"", infinity, infinity, 6}, 0.05), TargetVerdict::not_decided);
}

TEST(TargetVerdict, OnTheWholeIsThatOfTheWorstTarget)
{
  using enum TargetVerdict;
  EXPECT_EQ(feldspar::verdict_on({reached, reached}), reached);
  EXPECT_EQ(feldspar::verdict_on({reached, not_decided}), not_decided);
  EXPECT_EQ(feldspar::verdict_on({missed, not_decided, reached}), missed);
  EXPECT_EQ(feldspar::verdict_on(std::vector<TargetVerdict>{}), not_decided);
  for (const TargetVerdict one : {reached, missed, not_decided})
    EXPECT_EQ(verdict_of_name(name(one)), one);
  EXPECT_FALSE(verdict_of_name("met"));
}

/// Packings as a calibration tests them: three, then as many as their scatter asks for.
TargetOutcome tested(Random& random, const double mean, const double scatter, const double tolerance,
                     const std::size_t most)
{
  std::vector<double> values;
  TargetOutcome outcome{};
  for (std::size_t needed = std::min<std::size_t>(3, most); values.size() < needed;
       needed = packings_needed({outcome}, tolerance, most))
    {
      while (values.size() < needed)
        values.push_back(random.normal(mean, scatter));
      outcome = outcome_of_values(values);
    }
  return outcome;
}

// A mean just beyond the tolerance is the worst case. At 5 % with 1000 draws the rate has a standard deviation of 0.7 %, and
// six times fifteen rates may exceed it by three and a half of those. "Error and one standard error within the tolerance"
// calls 21 to 23 % reached where packings suffice, two standard errors more than half.
TEST(TargetVerdict, CallsAtMostOneInTwentyFalselyReachedOnKnownScatter)
{
  constexpr double tolerance = 0.05;
  constexpr int n_draws = 1000;
  Random random(57, RandomStream::strengths);
  double largest_rate = 0.0;
  double largest_of_one_error = 0.0;
  for (const double scatter : {1.5, 2.5, 5.0, 10.0, 15.0}) // of 100; the tolerance is 5
    for (const std::size_t most : {6u, 12u, 64u})
      {
        int n_reached = 0;
        int n_missed = 0;
        int n_by_one_error = 0;
        for (int draw = 0; draw < n_draws; ++draw)
          {
            const TargetOutcome beyond = tested(random, 105.0, scatter, tolerance, most);
            const TargetVerdict verdict = verdict_on(beyond, tolerance);
            n_reached += verdict == TargetVerdict::reached;
            n_missed += verdict == TargetVerdict::missed;
            n_by_one_error += std::abs(beyond.deviation()) + *beyond.reached->standard_error / 100.0 <= tolerance;
          }
        EXPECT_LE(n_reached, 0.075 * n_draws) << scatter << ", " << most;
        EXPECT_LE(n_missed, 0.075 * n_draws) << scatter << ", " << most;
        largest_rate = std::max(largest_rate, double(n_reached) / n_draws);
        largest_of_one_error = std::max(largest_of_one_error, double(n_by_one_error) / n_draws);
      }
  EXPECT_GT(largest_of_one_error, 0.2) << "the wrong rule would not have been noticed";
  EXPECT_GT(largest_rate, 0.02) << "stricter than it says";
}

// The verdict does decide: on target, with the packings it asks for, the half of the tolerance that is left is two
// standard errors of a mean, which 19 of 20 keep.
TEST(TargetVerdict, DecidesByThePackingsItAsksFor)
{
  constexpr double tolerance = 0.05;
  Random random(58, RandomStream::strengths);
  int n_reached = 0;
  int n_missed = 0;
  constexpr int n_draws = 500;
  for (int draw = 0; draw < n_draws; ++draw)
    {
      n_reached += verdict_on(tested(random, 100.0, 7.0, tolerance, 200), tolerance) == TargetVerdict::reached;
      n_missed += verdict_on(tested(random, 112.0, 7.0, tolerance, 200), tolerance) == TargetVerdict::missed;
    }
  EXPECT_GT(n_reached, 0.92 * n_draws);
  EXPECT_GT(n_missed, 0.99 * n_draws);
}

TEST(PackingsNeeded, BringTheIntervalToHalfOfTheTolerance)
{
  // 2.0003 · 5.9 / √61 = 1.511, 1.9996 · 5.9 / √62 = 1.498: the least for 1.5. The normal factor 1.96 would give 60.
  EXPECT_EQ(packings_for(0.015, 0.059), 62u);
  // Standard deviation of 100 - d and 100 + d is d √2.
  const double d = 5.9 / std::sqrt(2.0);
  EXPECT_EQ(packings_needed({outcome_of_values({100.0 - d, 100.0 + d})}, 0.03, 1000), 62u);
  EXPECT_EQ(packings_needed({outcome_of_values({100.0 - d, 100.0 + d})}, 0.03, 48), 48u);
  EXPECT_EQ(packings_needed({outcome_of_values({100.0})}, 0.03, 12), 12u)
    << "one specimen tells no scatter: all there are";
  // Six packings with a standard error of 4 % scatter by 9.8 %. Off by 1 % of 3 %, two are left: 1.986 · 9.8 / √95 = 1.997.
  EXPECT_EQ(packings_to_decide({"", 0.01, 0.04, 6}, 0.03), 95u);
  EXPECT_FALSE(packings_to_decide({"", 0.0299999, 0.04, 6}, 0.03)) << "at the edge itself no number does";
  EXPECT_FALSE(packings_to_decide({"", 0.01, std::nullopt, 1}, 0.03));
  EXPECT_FALSE(packings_for(0.0, 0.1));
  EXPECT_FALSE(packings_for(0.1, std::numeric_limits<double>::quiet_NaN()));
}

TEST(AnotherRound, IsWorthItsPackingsWhereTheyCanDecide)
{
  const auto outcome = [](const double mean, const double standard_error) {
    TargetOutcome one = outcome_of_values({100.0, 100.0});
    one.reached = Statistics{12, mean, standard_error * std::sqrt(12.0), standard_error, 2.2 * standard_error};
    return one;
  };
  EXPECT_FALSE(is_worth_another_round({outcome(100.5, 1.0)}, 0.03)) << "reached";
  EXPECT_TRUE(is_worth_another_round({outcome(110.0, 2.0)}, 0.03)) << "missed";
  EXPECT_TRUE(is_worth_another_round({outcome(102.5, 1.0)}, 0.03)) << "100.3 to 104.7: a better place would be reached";
  EXPECT_FALSE(is_worth_another_round({outcome(102.5, 2.0)}, 0.03)) << "98.1 to 106.9: nowhere could that be told";
}

TEST(StatementOnTargets, SaysWhatWasMissedAndHowManyPackingsWouldDecide)
{
  const TargetMean strength{"uniaxial compressive strength", 0.062, 0.01, 24};
  EXPECT_EQ(statement_on({{"", 0.01, 0.005, 24}}, 0.03), "All targets were reached within 3 %.");
  EXPECT_EQ(statement_on({strength}, 0.03),
            "not all targets were reached; off by more than the tolerance of 3 %: uniaxial "
            "compressive strength +6.2 ± 2.1 %");
  const TargetMean modulus{"Young's modulus, initial", -0.01, 0.04, 6};
  EXPECT_EQ(
    statement_on({modulus}, 0.03),
    "it is not decided whether all targets were reached within 3 %: Young's modulus, initial -1.0 ± 10.3 % (about 95 "
    "packings needed); raise Calibration/Most packings, test larger specimens or widen Calibration/Tolerance");
  EXPECT_EQ(
    statement_on({strength, modulus, {"tensile strength", 0.02, std::nullopt, 1}}, 0.03),
    "not all targets were reached; off by more than the tolerance of 3 %: uniaxial compressive strength +6.2 ± 2.1 "
    "%; not decided: Young's modulus, initial -1.0 ± 10.3 % (about 95 packings needed); tensile strength (given by 1 "
    "of the two packings that an interval needs at least)");
}
} // namespace
} // namespace feldspar::calibration

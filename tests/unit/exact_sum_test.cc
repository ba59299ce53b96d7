#include "dem/storage/exact_sum.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <vector>

namespace feldspar
{
namespace
{
double sum_of(const std::vector<double>& values)
{
  ExactSum sum;
  for (const double value : values)
    sum.add(value);
  return sum.value();
}

/// Numbers of both signs over 60 decades, from a linear congruence.
std::vector<double> wild_numbers(const std::size_t n)
{
  std::vector<double> numbers;
  std::uint64_t state = 1;
  for (std::size_t k = 0; k < n; ++k)
    {
      state = 6364136223846793005ull * state + 1442695040888963407ull;
      const double mantissa = double(std::int64_t(state)) / 9.2e18;
      numbers.push_back(std::ldexp(mantissa, int(state % 200) - 100));
    }
  return numbers;
}

TEST(ExactSum, LosesNothing)
{
  EXPECT_EQ(sum_of({}), 0.0);
  EXPECT_EQ(sum_of({1e100, 1.0, -1e100}), 1.0);
  EXPECT_EQ(sum_of({-1e300, -3.0, 1e300}), -3.0);
  EXPECT_EQ(sum_of({-0.1}), -0.1);
  constexpr double largest = std::numeric_limits<double>::max(), smallest = std::numeric_limits<double>::denorm_min();
  EXPECT_EQ(sum_of({largest, smallest, -largest}), smallest);
  EXPECT_EQ(sum_of({-largest, -smallest, largest}), -smallest);
  EXPECT_EQ(sum_of(std::vector<double>(1000, -0.5)), -500.0);
  EXPECT_EQ(sum_of({largest, -largest / 2.0}), largest / 2.0);
}

TEST(ExactSum, DependsOnNoOrderAndNoDivision)
{
  std::vector<double> numbers = wild_numbers(5000);
  const double sum = sum_of(numbers);
  std::ranges::sort(numbers);
  EXPECT_EQ(sum_of(numbers), sum);
  std::ranges::reverse(numbers);
  EXPECT_EQ(sum_of(numbers), sum);
  std::vector<ExactSum> parts(7);
  for (std::size_t k = 0; k < numbers.size(); ++k)
    parts[k % parts.size()].add(numbers[k]);
  ExactSum total;
  for (const ExactSum& part : parts)
    total.add(part);
  EXPECT_EQ(total.value(), sum);

  long double reference = 0.0; // sorted by magnitude: 64 bits, some more than the largest numbers have
  std::ranges::sort(numbers, {}, [](const double value) { return std::abs(value); });
  for (const double value : numbers)
    reference += value;
  EXPECT_NEAR(sum, double(reference), 1e-15 * std::abs(sum));
}

TEST(ExactSum, KnowsWhatIsNoNumber)
{
  constexpr double infinity = std::numeric_limits<double>::infinity();
  EXPECT_EQ(sum_of({1.0, infinity}), infinity);
  EXPECT_EQ(sum_of({-infinity, 1.0}), -infinity);
  EXPECT_TRUE(std::isnan(sum_of({infinity, -infinity})));
  EXPECT_TRUE(std::isnan(sum_of({std::nan(""), 1.0})));
}
} // namespace
} // namespace feldspar

#pragma once

#include <optional>
#include <vector>

namespace feldspar
{
/// A sample of equally trusted values.
struct Statistics
{
  std::size_t n = 0;
  double mean = 0.0;
  std::optional<double> standard_deviation; ///< of the sample (n - 1); none for one value
  std::optional<double> standard_error;     ///< of the mean
  std::optional<double> confidence_95;      ///< half-width of the interval of the mean, by Student's t
};

/// An interval that holds a true value with a probability of 95 %.
struct Interval
{
  double low, high;
};

/// Student's t: half-width of the 95 % interval over the standard error.
double student_factor_95(std::size_t degrees_of_freedom);

/// Interval of the true standard deviation over that of n values, by chi-squared: 0.69 to 1.83 for ten values, 0.52 to
/// 6.28 for three. Needs two values or more; they come from a normal distribution.
Interval deviation_interval_95(std::size_t n);

/// Statistics of the values; none for no values.
std::optional<Statistics> statistics(const std::vector<double>& values);
} // namespace feldspar

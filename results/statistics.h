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

/// Student's t: half-width of the 95 % interval over the standard error.
double student_factor_95(std::size_t degrees_of_freedom);

/// None for no values.
std::optional<Statistics> statistics(const std::vector<double>& values);
} // namespace feldspar

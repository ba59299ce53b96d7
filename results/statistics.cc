#include "results/statistics.h"

#include <boost/math/distributions/chi_squared.hpp>
#include <boost/math/distributions/students_t.hpp>

#include <cmath>

namespace feldspar
{
double student_factor_95(const std::size_t degrees_of_freedom)
{
  const boost::math::students_t student{double(degrees_of_freedom)};
  return boost::math::quantile(boost::math::complement(student, 0.5 * (1.0 - 0.95)));
}

Interval deviation_interval_95(const std::size_t n)
{
  const double freedom = double(n - 1);
  const boost::math::chi_squared squares{freedom};
  const double tail = 0.5 * (1.0 - 0.95);
  return {std::sqrt(freedom / boost::math::quantile(boost::math::complement(squares, tail))),
          std::sqrt(freedom / boost::math::quantile(squares, tail))};
}

std::optional<Statistics> statistics(const std::vector<double>& values)
{
  if (values.empty())
    return std::nullopt;
  Statistics result;
  result.n = values.size();
  for (const double value : values)
    result.mean += value / double(result.n);
  if (result.n > 1)
    {
      double squares = 0.0;
      for (const double value : values)
        squares += (value - result.mean) * (value - result.mean);
      result.standard_deviation = std::sqrt(squares / double(result.n - 1));
      result.standard_error = *result.standard_deviation / std::sqrt(double(result.n));
      result.confidence_95 = student_factor_95(result.n - 1) * *result.standard_error;
    }
  return result;
}
} // namespace feldspar

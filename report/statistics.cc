#include "report/statistics.h"

#include <boost/math/distributions/students_t.hpp>

#include <cmath>

namespace feldspar
{
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
      const boost::math::students_t student{double(result.n - 1)};
      result.confidence_95 =
        boost::math::quantile(boost::math::complement(student, 0.5 * (1.0 - 0.95))) * *result.standard_error;
    }
  return result;
}
} // namespace feldspar

#include "report/statistics.h"

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
    }
  return result;
}
} // namespace feldspar

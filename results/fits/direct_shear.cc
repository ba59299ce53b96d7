#include "results/fits/direct_shear.h"

#include <cmath>

namespace feldspar
{
ShearLineResult fit_shear_line(const std::vector<const FinishedTest*>& tests)
{
  std::vector<double> normal;
  std::vector<double> shear;
  for (const FinishedTest* const test : tests)
    if (test->record.kind.pressure_acts_across && test->was_made() && test->results.peak_stress.value)
      {
        normal.push_back(test->record.confining_pressure);
        shear.push_back(*test->results.peak_stress.value);
      }
  const auto n = double(normal.size());
  double mean_x = 0.0;
  double mean_y = 0.0;
  for (std::size_t k = 0; k < normal.size(); ++k)
    {
      mean_x += normal[k] / n;
      mean_y += shear[k] / n;
    }
  double xx = 0.0;
  double xy = 0.0;
  double yy = 0.0;
  for (std::size_t k = 0; k < normal.size(); ++k)
    {
      xx += (normal[k] - mean_x) * (normal[k] - mean_x);
      xy += (normal[k] - mean_x) * (shear[k] - mean_y);
      yy += (shear[k] - mean_y) * (shear[k] - mean_y);
    }
  if (!(xx > 0.0))
    return {std::nullopt, "needs shear tests with a peak under two normal stresses"};
  const double slope = xy / xx;
  return {ShearLine{mean_y - slope * mean_x, std::atan(slope), yy > 0.0 ? xy * xy / (xx * yy) : 1.0, normal.size()},
          ""};
}
} // namespace feldspar

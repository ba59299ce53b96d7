#pragma once

#include <vector>

namespace feldspar
{
/// Means of paired values and sums of the products of their deviations: what slopes and correlations are made of.
struct PairedMoments
{
  double mean_x = 0.0;
  double mean_y = 0.0;
  double xx = 0.0;
  double xy = 0.0;
  double yy = 0.0;

  double slope() const { return xy / xx; } ///< of y over x by least squares
};

/// `x` and `y` have as many values.
inline PairedMoments paired_moments(const std::vector<double>& x, const std::vector<double>& y)
{
  PairedMoments of;
  const auto n = double(x.size());
  for (std::size_t k = 0; k < x.size(); ++k)
    {
      of.mean_x += x[k] / n;
      of.mean_y += y[k] / n;
    }
  for (std::size_t k = 0; k < x.size(); ++k)
    {
      of.xx += (x[k] - of.mean_x) * (x[k] - of.mean_x);
      of.xy += (x[k] - of.mean_x) * (y[k] - of.mean_y);
      of.yy += (y[k] - of.mean_y) * (y[k] - of.mean_y);
    }
  return of;
}
} // namespace feldspar

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
PairedMoments paired_moments(const std::vector<double>& x, const std::vector<double>& y);
} // namespace feldspar

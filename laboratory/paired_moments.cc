#include "laboratory/paired_moments.h"

namespace feldspar
{
PairedMoments paired_moments(const std::vector<double>& x, const std::vector<double>& y)
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

#include "results/fits/direct_shear.h"

#include "laboratory/paired_moments.h"

#include <cmath>

namespace feldspar
{
FitOrReason<ShearLine> fit_shear_line(const std::vector<const FinishedTest*>& tests)
{
  std::vector<double> normal;
  std::vector<double> shear;
  for (const FinishedTest* const test : tests)
    if (test->record.kind.pressure_acts_across && test->was_made() && test->results.peak_stress.value &&
        test->results.normal_stress_at_peak.value)
      {
        normal.push_back(*test->results.normal_stress_at_peak.value);
        shear.push_back(*test->results.peak_stress.value);
      }
  const PairedMoments of = paired_moments(normal, shear);
  if (!(of.xx > 0.0))
    return {std::nullopt, "needs shear tests with a peak under two normal stresses"};
  const double slope = of.slope();
  return {ShearLine{of.mean_y - slope * of.mean_x, std::atan(slope),
                    of.yy > 0.0 ? of.xy * of.xy / (of.xx * of.yy) : 1.0, normal.size()},
          ""};
}
} // namespace feldspar

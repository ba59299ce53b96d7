#include "results/fits/strength_data.h"

#include "results/statistics.h"

#include <map>

namespace feldspar
{
StrengthData strength_data(const std::vector<FinishedTest>& tests, const std::optional<std::string>& variant)
{
  std::map<double, std::vector<double>> by_confinement;
  std::vector<double> direct;
  std::vector<double> brazilian;
  for (const auto& test : tests)
    if (test.results.peak_stress.value && (!variant || test.variant == *variant))
      {
        const double strength = *test.results.peak_stress.value;
        if (test.record.kind == TestKind::direct_tension)
          direct.push_back(strength);
        else if (test.record.kind == TestKind::brazilian)
          brazilian.push_back(strength);
        else
          by_confinement[test.record.confining_pressure].push_back(strength);
      }

  StrengthData data;
  for (const auto& [sigma_3, strengths] : by_confinement)
    data.points.push_back({sigma_3, statistics(strengths)->mean});
  if (by_confinement.contains(0.0))
    data.uniaxial_compressive_strength = statistics(by_confinement[0.0])->mean;
  if (const auto mean = statistics(direct.empty() ? brazilian : direct))
    data.tensile_strength = mean->mean;
  return data;
}
} // namespace feldspar

#include "results/fits/run_envelopes.h"

#include "results/statistics.h"

#include <algorithm>

namespace feldspar
{
StrengthData strength_data(const std::vector<FinishedTest>& tests, const std::optional<std::string>& variant)
{
  std::map<double, std::vector<double>> by_confinement;
  std::vector<double> direct;
  std::vector<double> indirect;
  for (const auto& test : tests)
    if (test.results.peak_stress.value && test.results.is_valid() && (!variant || test.variant == *variant))
      {
        const double strength = *test.results.peak_stress.value;
        const EnvelopeRole role = test.record.envelope_role();
        if (role == EnvelopeRole::compression)
          by_confinement[test.record.confining_pressure].push_back(strength);
        else if (role != EnvelopeRole::none)
          (role == EnvelopeRole::tension ? direct : indirect).push_back(strength);
      }

  StrengthData data;
  data.of_flawed_body = std::ranges::any_of(
    tests, [&](const FinishedTest& test) { return test.has_flaws() && (!variant || test.variant == *variant); });
  for (const auto& [sigma_3, strengths] : by_confinement)
    data.points.push_back({sigma_3, statistics(strengths)->mean});
  if (by_confinement.contains(0.0))
    data.uniaxial_compressive_strength = statistics(by_confinement[0.0])->mean;
  if (const auto mean = statistics(direct.empty() ? indirect : direct))
    {
      data.tensile_strength = mean->mean;
      data.tension_is_indirect = direct.empty();
    }
  return data;
}

RunEnvelopes fit_each_rock(const std::vector<FinishedTest>& tests)
{
  RunEnvelopes envelopes;
  for (const auto& test : tests)
    if (!envelopes.contains(test.variant))
      envelopes[test.variant] = fit_strength_envelopes(strength_data(tests, test.variant));
  return envelopes;
}
} // namespace feldspar

#include "results/fits/run_envelopes.h"

#include "results/fits/strength_data.h"

namespace feldspar
{
RunEnvelopes fit_each_rock(const std::vector<FinishedTest>& tests)
{
  RunEnvelopes envelopes;
  for (const auto& test : tests)
    if (!envelopes.contains(test.variant))
      envelopes[test.variant] = fit_strength_envelopes(strength_data(tests, test.variant));
  return envelopes;
}
} // namespace feldspar

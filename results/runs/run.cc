#include "results/runs/run.h"

#include <utility>

namespace feldspar
{
FinishedTest finished(TestOutcome outcome, std::string group, std::string name, std::string variant,
                      std::vector<VariantSetting> settings)
{
  TestResults results = evaluate(outcome.record);
  return {std::move(group),
          std::move(name),
          std::move(variant),
          std::move(settings),
          std::move(outcome.record),
          std::move(results),
          std::move(outcome.appearance),
          std::move(outcome.bookkeeping)};
}
} // namespace feldspar

#include "results/runs/run.h"

#include <algorithm>
#include <utility>

namespace feldspar
{
std::string Provenance::value_of(const input_entries::EntryName& wanted) const
{
  const auto found = std::ranges::find_if(
    input, [&](const InputEntry& one) { return one.section == wanted.section && one.entry == wanted.entry; });
  return found == input.end() ? "" : found->value;
}

std::string Provenance::label_of(const input_entries::EntryName& wanted) const
{
  const std::string value = value_of(wanted);
  return value == "none" ? "" : value;
}

bool any_has_flaws(const std::vector<FinishedTest>& tests)
{
  return std::ranges::any_of(tests, &FinishedTest::has_flaws);
}

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

#include "results/evaluation.h"

#include "laboratory/peak.h"
#include "results/evaluation/rising_branch.h"

namespace feldspar
{
namespace
{
/// The figure of a row of the table; `why_no_peak`: where there is no branch.
Figure figure_of(const TestQuantity& quantity, const TestRecord& record, const std::optional<RisingBranch>& branch,
                 const std::string& why_no_peak)
{
  const auto* const at_peak = std::get_if<Figure (*)(const RisingBranch&)>(&quantity.evaluate);
  if (at_peak && !branch)
    return unknown(why_no_peak);
  if (quantity.tests.objection)
    if (const char* const reason = quantity.tests.objection(record))
      return unknown(reason);
  return at_peak ? (*at_peak)(*branch) : std::get<Figure (*)(const TestRecord&)>(quantity.evaluate)(record);
}
} // namespace

TestResults evaluate(const TestRecord& record)
{
  TestResults results;
  if (!record.curve.empty())
    {
      const CurveSample& last = record.curve.back();
      results.n_tension_cracks = last.n_tension_cracks;
      results.n_shear_cracks = last.n_shear_cracks;
      results.energy_imbalance = last.energies.imbalance();
      results.energy_imbalance_over_work = last.energies.imbalance_over_work();
    }
  // A maximum before the stop rule was met may not be a peak.
  const PeakVerdict verdict =
    record.interrupted
      ? PeakVerdict{std::nullopt, record.failure.empty() ? "interrupted before its end" : record.failure}
      : find_peak(record);
  std::optional<RisingBranch> branch;
  if (verdict.row)
    branch.emplace(record, *verdict.row);
  for (const TestQuantity& quantity : test_quantities)
    if (quantity.figure())
      results.*quantity.figure() = figure_of(quantity, record, branch, verdict.reason);
  return results;
}
} // namespace feldspar

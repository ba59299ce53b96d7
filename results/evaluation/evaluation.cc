#include "results/evaluation.h"

#include "laboratory/peak.h"
#include "results/evaluation/rising_branch.h"

namespace feldspar
{
namespace
{
/// The part of a test without a peak that gives its elastic constants: up to its highest deviator before the first crack,
/// if this is more than waves can bring about.
std::optional<RisingBranch> part_before_cracks(const TestRecord& record)
{
  PeakWatch watch(record.kind, record.confining_pressure, record.peak_demands);
  for (const CurveSample& row : record.curve)
    {
      if (row.n_cracks() > 0)
        break;
      watch.add(row);
    }
  if (!watch.is_borne() || watch.is_too_early())
    return std::nullopt;
  return RisingBranch(record, watch.row(), {0.25, 1.0});
}

/// The figure of a row of the table; `why_no_peak`: where the branch does not end at a peak, or there is none.
Figure figure_of(const TestQuantity& quantity, const TestRecord& record, const std::optional<RisingBranch>& branch,
                 const std::string& why_no_peak)
{
  const auto* const at_peak = std::get_if<Figure (*)(const RisingBranch&)>(&quantity.evaluate);
  const char* const objection = quantity.tests.objection ? quantity.tests.objection(record) : nullptr;
  if (at_peak && !why_no_peak.empty() && !(branch && quantity.needs_no_peak))
    return unknown(why_no_peak + (quantity.needs_no_peak && !objection && !record.interrupted
                                    ? "; too little of the curve lies before the first crack"
                                    : ""));
  if (objection)
    return unknown(objection);
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
  const std::optional<RisingBranch> branch = verdict.row          ? RisingBranch(record, *verdict.row)
                                             : record.interrupted ? std::nullopt
                                                                  : part_before_cracks(record);
  for (const TestQuantity& quantity : test_quantities)
    if (quantity.figure())
      results.*quantity.figure() = figure_of(quantity, record, branch, verdict.reason);
  return results;
}
} // namespace feldspar

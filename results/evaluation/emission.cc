#include "results/emission.h"
#include "results/evaluation/rising_branch.h"

/// The acoustic emission of a test up to its peak.
namespace feldspar
{
namespace
{
/// Magnitudes of the events up to the peak.
std::vector<double> magnitudes(const RisingBranch& branch)
{
  std::vector<double> result;
  for (const EmissionEvent& event : branch.record.events)
    if (event.time <= branch.at_peak().time)
      result.push_back(mechanism(event, branch.record.dimension()).magnitude);
  return result;
}

Figure of_frequency(const RisingBranch& branch, double MagnitudeFrequency::*const part)
{
  const auto frequency = magnitude_frequency(magnitudes(branch));
  return frequency ? known((*frequency).*part) : unknown("fewer than 30 events above the magnitude of completeness");
}
} // namespace

namespace evaluation
{
Figure n_events_at_peak(const RisingBranch& branch) { return known(double(magnitudes(branch).size())); }

Figure b_value(const RisingBranch& branch) { return of_frequency(branch, &MagnitudeFrequency::b); }

Figure b_value_error(const RisingBranch& branch) { return of_frequency(branch, &MagnitudeFrequency::error); }

Figure b_positive(const RisingBranch& branch) { return of_frequency(branch, &MagnitudeFrequency::b_positive); }
} // namespace evaluation
} // namespace feldspar

#include "results/emission.h"
#include "results/evaluation/rising_branch.h"

/// The acoustic emission of a test up to its peak.
namespace feldspar
{
namespace
{
std::vector<EmissionEvent> events_of(const RisingBranch& branch)
{
  return events_up_to_peak(branch.record, branch.strain(branch.at_peak()));
}

Figure of_frequency(const RisingBranch& branch, double MagnitudeFrequency::*const part)
{
  const auto frequency = magnitude_frequency(magnitudes_of(events_of(branch), branch.record.dimension()));
  return frequency ? known((*frequency).*part) : unknown("fewer than 30 events above the magnitude of completeness");
}
} // namespace

namespace evaluation
{
Figure n_events_at_peak(const RisingBranch& branch) { return known(double(events_of(branch).size())); }

Figure b_value(const RisingBranch& branch) { return of_frequency(branch, &MagnitudeFrequency::b); }

Figure b_value_error(const RisingBranch& branch) { return of_frequency(branch, &MagnitudeFrequency::error); }

Figure b_positive(const RisingBranch& branch) { return of_frequency(branch, &MagnitudeFrequency::b_positive); }
} // namespace evaluation
} // namespace feldspar

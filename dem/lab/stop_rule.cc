#include "dem/lab/stop_rule.h"

namespace feldspar
{
namespace
{
// Of a notched body, over its depth or length. Rock breaks before a hundredth, and a body that rocks at first soon after it.
constexpr double farthest_without_crack = 0.05;

bool is_whole(const CurveSample& row) { return row.n_tension_cracks + row.n_shear_cracks == 0; }
} // namespace

bool StopRule::bears_nothing(const CurveSample& row, const TestParameters& wanted) const
{
  return needs_crack && is_whole(row) && !wanted.stop_strain && kind.strain(row) >= farthest_without_crack;
}

bool StopRule::is_met_by(const CurveSample& row, const double confining_pressure, const TestParameters& wanted)
{
  const double strain = kind.strain(row);
  const double deviator = kind.deviator(row, confining_pressure);
  if (peak.is_highest(deviator))
    strain_at_peak = strain;
  // A row that is meant to be there may lack a last bit, which differs between numbers of processes.
  constexpr double but_for_round_off = 1.0 - 1e-9;
  if (strain >= but_for_round_off * wanted.stop_strain.value_or(largest_axial_strain))
    return true;
  if (needs_crack && is_whole(row) && !wanted.stop_strain)
    return bears_nothing(row, wanted);
  // Waves ripple the first rows; a peak without a crack, of a specimen that still carries most of it, is not the rock's.
  if (is_whole(row) && deviator > 0.9 * peak.highest)
    return false;
  const bool is_far_beyond_peak = strain >= wanted.stop_strain_over_peak_strain * strain_at_peak;
  if (wanted.stop_stress_over_peak)
    {
      // After its first fall a disc may bear more than before and never fall to that share.
      const bool may_rise_again = peak.rule == PeakRule::first_before_a_fall && peak.fallen;
      return deviator <= *wanted.stop_stress_over_peak * peak.highest ||
             (may_rise_again && is_far_beyond_peak && !wanted.stop_strain);
    }
  if (wanted.stop_strain)
    return false;
  return is_far_beyond_peak;
}
} // namespace feldspar

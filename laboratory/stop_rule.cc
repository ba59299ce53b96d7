#include "laboratory/stop_rule.h"

#include <numbers>

namespace feldspar
{
namespace
{
// Rock breaks at strains below 0.01 (of a notched body over its depth or length), in tension below 0.001. A body that
// rocks at first, or first closes an open flaw, breaks soon after these.
constexpr double farthest_unheld_pressed = 0.05;
constexpr double farthest_unheld_pulled = 0.01;

bool is_whole(const CurveSample& row) { return row.n_tension_cracks + row.n_shear_cracks == 0; }
} // namespace

bool StopRule::bears_nothing(const CurveSample& row, const TestParameters& wanted) const
{
  const bool is_borne = needs_crack ? !is_whole(row) : peak.highest() >= peak.demands().least_stress;
  return !is_borne && !wanted.stop_strain &&
         kind.strain(row) >= (kind.sign > 0.0 && !needs_crack ? farthest_unheld_pulled : farthest_unheld_pressed);
}

bool StopRule::is_met_by(const CurveSample& row, const TestParameters& wanted) const
{
  const double strain = kind.strain(row);
  // A row that is meant to be there may lack a last bit, which differs between numbers of processes.
  constexpr double but_for_round_off = 1.0 - 1e-9;
  const double last_strain = kind.tilts ? 0.5 * std::numbers::pi : largest_axial_strain;
  if (strain >= but_for_round_off * wanted.stop_strain.value_or(last_strain) || bears_nothing(row, wanted))
    return true;
  if (needs_crack && is_whole(row) && !wanted.stop_strain)
    return false;
  if (!peak.is_borne())
    return false;
  const double ratio = wanted.stop_strain_over_peak_strain;
  const bool is_far_beyond_peak = strain >= ratio * peak.strain() && row.time >= ratio * peak.demands().least_time;
  if (wanted.stop_stress_over_peak)
    {
      // After its first fall a disc, or a body that a machine goes on to press, may carry more and never fall to that share.
      const bool may_rise_again =
        (kind.peak_rule == PeakRule::first_before_a_fall || peak.demands().stress_rate > 0.0) && !wanted.stop_strain;
      return peak.has_fallen() && (kind.deviator(row, pressure) <= *wanted.stop_stress_over_peak * peak.highest() ||
                                   (may_rise_again && is_far_beyond_peak));
    }
  return !wanted.stop_strain && is_far_beyond_peak && ((peak.has_fallen() && !peak.is_rising()) || peak.is_level());
}
} // namespace feldspar

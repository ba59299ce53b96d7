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
} // namespace

bool StopRule::bears_nothing(const CurveSample& row, const TestParameters& parameters) const
{
  const bool is_held = needs_crack ? row.n_cracks() > 0 : highest() >= demands().least_stress;
  return !is_held && !parameters.stop_strain &&
         kind.strain(row) >= (kind.sign > 0.0 && !needs_crack ? farthest_unheld_pulled : farthest_unheld_pressed);
}

bool StopRule::is_met_by(const CurveSample& row, const TestParameters& parameters) const
{
  const double reached = kind.strain(row);
  // A row that is meant to be there may lack a last bit, which differs between numbers of processes.
  constexpr double but_for_round_off = 1.0 - 1e-9;
  const double last_strain = kind.tilts ? 0.5 * std::numbers::pi : largest_axial_strain;
  if (reached >= but_for_round_off * parameters.stop_strain.value_or(last_strain) || bears_nothing(row, parameters))
    return true;
  if (needs_crack && row.n_cracks() == 0 && !parameters.stop_strain)
    return false;
  if (!is_borne())
    return false;
  const double ratio = parameters.stop_strain_over_peak_strain;
  const bool is_far_beyond_peak = reached >= ratio * strain() && row.time >= ratio * demands().least_time;
  if (parameters.stop_stress_over_peak)
    {
      // After its first fall a disc, or a body that a machine goes on to press, may carry more and never fall to that share.
      const bool may_rise_again =
        (kind.peak_rule == PeakRule::first_before_a_fall || demands().stress_rate > 0.0) && !parameters.stop_strain;
      return has_fallen() && (kind.deviator(row, pressure) <= *parameters.stop_stress_over_peak * highest() ||
                              (may_rise_again && is_far_beyond_peak));
    }
  return !parameters.stop_strain && is_far_beyond_peak && ((has_fallen() && !is_rising()) || is_level());
}
} // namespace feldspar

#include "laboratory/peak.h"

#include "laboratory/named_entries.h"
#include "laboratory/paired_moments.h"
#include "laboratory/record.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace feldspar
{
namespace
{
constexpr double round_off = 1e-9;      // a plateau peaks where it begins
constexpr double level_within = 0.01;   // of the highest stress
constexpr double waver_of_level = 0.05; // about the mean
constexpr double most_lag = 0.05;       // of the stress behind a machine that raises it

/// A plane that slides, or a solid that yields, carries its strength to the end: any row may be the highest by a
/// little, the last one too.
bool keeps_its_strength(const TestRecord& record)
{
  if (!record.kind.pressure_acts_across && record.body != TestBody::finite_elements)
    return false;
  const auto& curve = record.curve;
  const double before = mobilised(record, curve[9 * (curve.size() - 1) / 10]);
  const double last = mobilised(record, curve.back());
  return before > share_of_strength * last && (record.kind.pressure_acts_across || last > share_of_strength * before);
}

/// Returns whether a body on a tilted plate slides: at rest the tangent of the tilt is the ratio of both stresses.
bool slides(const TestKind& kind, const CurveSample& row)
{
  constexpr double least_lag = 0.01;
  return kind.tilts && kind.stress(row) < -row.lateral_stress * (std::tan(kind.strain(row)) - least_lag);
}

PeakWatch watch_of(const TestRecord& record)
{
  PeakWatch watch(record.kind, record.confining_pressure, record.peak_demands);
  for (const CurveSample& row : record.curve)
    watch.add(row);
  return watch;
}

/// Why the highest stress of a curve is no peak; empty if it is one.
std::string objection(const TestRecord& record, const PeakWatch& watch)
{
  if (watch.row() == 0 || !(watch.highest() > 0.0))
    return "the stress never peaked";
  const double highest = record.kind.stress(record.curve[watch.row()]) / 1e6;
  if (!watch.is_borne())
    return fmt::format(
      "the highest stress, {:.3g} MPa, is below {:.3g} MPa, which waves can bring about at this rate in a body that "
      "nothing holds ({}); lower the rate, if the body is whole",
      highest, watch.demands().least_stress / 1e6, input_entries::least_stress.text());
  if (watch.is_too_early())
    return fmt::format(
      "the highest stress, {:.3g} MPa, came after {:.3g} µs, when waves had not yet spread it over the "
      "specimen, which takes {:.3g} µs ({}); lower the strain rate",
      highest, 1e6 * record.curve[watch.row()].time, 1e6 * watch.demands().least_time,
      input_entries::least_transits.text());
  if (record.came_apart || keeps_its_strength(record) || watch.is_level())
    return "";
  if (watch.demands().may_end_rising && !record.kind.follows_stages) // a laboratory chooses where its record ends
    return "";
  const bool is_last = watch.row() + 1 == record.curve.size();
  const bool is_in_a_fall = watch.has_fallen() && watch.is_at_its_lowest();
  if (is_last || (!watch.demands().may_end_rising && watch.is_rising() && !is_in_a_fall))
    return fmt::format("the stress never peaked: it was still rising when the test ended; the highest was {:.4g} MPa",
                       highest);
  if (!watch.has_fallen())
    return fmt::format(
      "the stress never peaked: when the test ended it had not fallen by {:g} % from its highest, {:.4g} "
      "MPa ({})",
      100.0 * watch.demands().least_fall, highest, input_entries::least_fall.text());
  return "";
}
} // namespace

PeakWatch::PeakWatch(const TestKind& of_test, const double confining_pressure, const PeakDemands& demands)
  : kind(of_test)
  , pressure(confining_pressure)
  , wanted(demands)
{
  if (kind.follows_stages) // the highest stress of a table is no strength
    {
      wanted.least_stress = wanted.least_time = wanted.least_fall = 0.0;
      wanted.may_end_rising = true;
    }
}

void PeakWatch::add(const CurveSample& row)
{
  const double strain = kind.strain(row);
  const double deviator = kind.deviator(row, pressure);
  ways.push_back(strains.empty() ? 0.0 : ways.back() + std::abs(strain - strains.back()));
  strains.push_back(strain);
  deviators.push_back(deviator);
  lowest_since = std::min(lowest_since, deviator);
  is_first_peak = is_first_peak || slides(kind, row) ||
                  (kind.peak_rule == PeakRule::first_before_a_fall && is_borne() && !is_too_early() && has_fallen());
  if (wanted.stress_rate > 0.0 && is_borne() && !is_too_early())
    {
      const bool follows = deviator >= (1.0 - most_lag) * wanted.stress_rate * row.time;
      is_first_peak = is_first_peak || (has_followed && !follows && lagged_before); // a wave takes one row
      has_followed = has_followed || follows;
      lagged_before = !follows;
    }
  if (deviator <= highest_deviator * (1.0 + round_off) || is_first_peak)
    return;
  highest_deviator = lowest_since = deviator;
  row_of_highest = deviators.size() - 1;
  strain_at_highest = strain;
  time_of_highest = row.time;
}

bool PeakWatch::is_rising() const
{
  constexpr double share_of_way = 0.1;
  constexpr std::size_t fewest_rows = 3; // for a trend
  if (is_first_peak)
    return false;
  if (ways.size() < fewest_rows)
    return row_of_highest + 1 == ways.size();
  std::vector<double> x, y;
  const double begin = ways.back() - share_of_way * std::abs(strains.back());
  for (std::size_t k = ways.size(); k-- > 0 && (ways[k] >= begin || x.size() < fewest_rows);)
    {
      x.push_back(ways[k]);
      y.push_back(deviators[k]);
    }
  const PairedMoments moments = paired_moments(x, y);
  if (!(moments.xx > 0.0) || !(moments.xy > 0.0))
    return false;
  const double now = moments.mean_y + moments.slope() * (ways.back() - moments.mean_x);
  const double way_to_end = (wanted.end_over_peak_strain - 1.0) * strain_at_highest;
  return now + moments.slope() * way_to_end > (1.0 + level_within) * highest_deviator;
}

bool PeakWatch::is_at_its_lowest() const
{
  constexpr double regained = 0.1; // of the fall: waves behind it
  return !deviators.empty() && deviators.back() <= lowest_since + regained * (highest_deviator - lowest_since);
}

bool PeakWatch::is_level() const
{
  if (!(highest_deviator > 0.0 && strains.back() > 0.0))
    return false;
  std::vector<double> x, y;
  const double begin = (1.0 - round_off) * strains.back() / wanted.end_over_peak_strain;
  for (std::size_t k = strains.size(); k-- > 0 && strains[k] >= begin;)
    {
      x.push_back(strains[k]);
      y.push_back(deviators[k]);
    }
  const PairedMoments moments = paired_moments(x, y);
  const double mean = moments.mean_y;
  const auto first_at_mean =
    std::ranges::find_if(deviators, [&](const double s) { return s >= (1.0 - level_within) * mean; });
  const auto [lowest, highest] = std::ranges::minmax(y);
  if (!(moments.xx > 0.0) || first_at_mean == deviators.end() || lowest < (1.0 - waver_of_level) * mean ||
      std::max(highest, highest_deviator) > (1.0 + waver_of_level) * mean ||
      strains[std::size_t(first_at_mean - deviators.begin())] >
        strains.back() / ((1.0 - round_off) * wanted.end_over_peak_strain))
    return false;
  const double rise = moments.slope() * (x.front() - x.back());
  const double scatter = std::sqrt(std::max(0.0, moments.yy - moments.slope() * moments.xy) / double(x.size()));
  return rise <= std::max(level_within * mean, 2.0 * scatter);
}

PeakVerdict find_peak(const TestRecord& record)
{
  const PeakWatch watch = watch_of(record);
  std::string reason = record.curve.empty() ? "there is no curve" : objection(record, watch);
  if (reason.empty())
    return {watch.row(), ""};
  if (!record.ended_early.empty())
    reason += ": " + record.ended_early;
  return {std::nullopt, reason};
}

std::optional<std::size_t> peak_row(const TestRecord& record) { return find_peak(record).row; }

double mobilised(const TestRecord& record, const CurveSample& row)
{
  return record.kind.stress(row) / (record.normal_stiffness ? -row.lateral_stress : 1.0);
}

bool ends_rising(const TestRecord& record) { return !record.curve.empty() && watch_of(record).is_rising(); }
} // namespace feldspar

#include "laboratory/stage_walk.h"

#include "laboratory/peak.h"

#include <algorithm>

namespace feldspar
{
namespace
{
/// Returns whether the stress leads above its highest in the rows of a stage.
bool is_rising(const std::vector<CurveSample>& curve, const std::uint64_t first_row, const TestParameters& wanted)
{
  PeakWatch watch({.sign = -1.0}, 0.0, {.end_over_peak_strain = wanted.stop_strain_over_peak_strain});
  for (std::size_t k = first_row; k < curve.size(); ++k)
    watch.add(curve[k]);
  return watch.is_rising();
}
} // namespace

void StageWalk::begin(const StageMoment& now) { begin_next(0, now); }

void StageWalk::begin_next(const std::uint64_t row, const StageMoment& now)
{
  const LoadingStage& next = stages[begun.size()];
  begun.push_back({words(next), next.confining_pressure, row, row, false});
  start = now;
  widening_let_be = 0.0;
  highest_stress = now.axial_stress;
  strain_at_highest = now.axial_strain;
}

void StageWalk::begin_last(const std::uint64_t row, const StageMoment& now)
{
  const double reached = demand(now).confining_pressure;
  early.clear();
  begun.back().last_row = row;
  begin_next(row, now);
  pressure_before = reached;
}

bool StageWalk::needs_lateral_strain() const
{
  return std::ranges::any_of(stages, [](const LoadingStage& one) { return one.lateral_strain.has_value(); });
}

/// The confinement goes evenly with the strain or the time of the stage from one value to the next.
StageDemand StageWalk::demand(const StageMoment& now)
{
  const LoadingStage& running = stage();
  double share = 1.0;
  if (running.duration)
    share = (now.time - start.time) / *running.duration;
  else if (running.lateral_strain && *running.lateral_strain < start.lateral_strain)
    share = (now.lateral_strain - start.lateral_strain) / (*running.lateral_strain - start.lateral_strain);
  else if (running.axial_strain && *running.axial_strain != start.axial_strain)
    share = (now.axial_strain - start.axial_strain) / (*running.axial_strain - start.axial_strain);
  const double before = pressure_before.value_or(stages[begun.size() == 1 ? 0 : begun.size() - 2].confining_pressure);
  StageDemand result;
  result.confining_pressure = before + std::clamp(share, 0.0, 1.0) * (running.confining_pressure - before);
  result.closing_rate = 0.0;
  if (running.duration)
    result.held_stress = running.axial_stress;
  else if (running.lateral_strain)
    {
      // Widening by which a fracture has run ahead is kept but for this strain: to undo all of it would unload the
      // specimen.
      constexpr double most = 1e-4;
      const double ahead = start.lateral_strain - now.lateral_strain - rate_of(running) * (now.time - start.time);
      widening_let_be = std::clamp(widening_let_be, ahead - most, ahead + most);
      result.missing_widening = widening_let_be - ahead;
    }
  else
    {
      const bool presses =
        running.axial_strain ? *running.axial_strain > start.axial_strain : *running.axial_stress > start.axial_stress;
      result.closing_rate = (presses ? 1.0 : -1.0) * rate_of(running);
    }
  return result;
}

bool StageWalk::is_at_end_of_stage(const StageMoment& now) const
{
  const LoadingStage& running = stage();
  if (running.duration)
    return now.time - start.time >= *running.duration;
  const auto passes = [](const double value, const double from, const double target) {
    return target > from ? value >= target : value <= target;
  };
  if (running.lateral_strain)
    return now.lateral_strain <= *running.lateral_strain;
  return running.axial_strain ? passes(now.axial_strain, start.axial_strain, *running.axial_strain)
                              : passes(now.axial_stress, start.axial_stress, *running.axial_stress);
}

bool StageWalk::is_over(const std::vector<CurveSample>& curve, const StageMoment& now)
{
  const LoadingStage& running = stage();
  StageRecord& record = begun.back();
  record.last_row = curve.size() - 1;
  if (now.axial_stress > highest_stress)
    {
      highest_stress = now.axial_stress;
      strain_at_highest = now.axial_strain;
    }
  const auto give_up = [&](const std::string& why) {
    early = fmt::format("stage {} of {}, {}: {}", begun.size(), stages.size(), record.target, why);
    return true;
  };
  if (running.lateral_strain && start.lateral_strain <= *running.lateral_strain)
    return give_up(
      fmt::format("the specimen was as wide before it, at a lateral strain of {:.2g}", start.lateral_strain));
  if (is_at_end_of_stage(now))
    {
      record.reached = true;
      if (begun.size() == stages.size())
        return true;
      begin_next(record.last_row, now);
      pressure_before.reset();
      return false;
    }
  const double most = wanted.stop_strain.value_or(largest_axial_strain);
  if (now.axial_strain >= most)
    return give_up(fmt::format("not reached at an axial strain of {:g}, where the test stops", most));
  if (running.lateral_strain)
    {
      constexpr double most_times = 3.0;
      const double due_after = (start.lateral_strain - *running.lateral_strain) / rate_of(running);
      if (now.time - start.time > most_times * due_after)
        return give_up(fmt::format("the lateral strain has only come to {:.2g} in {:g} times as long as its rate takes",
                                   now.lateral_strain, most_times));
      return false;
    }
  if (!running.axial_stress || running.duration || *running.axial_stress <= start.axial_stress)
    return false;
  // Only where cracks have opened in the stage, and well above the waves of its first rows.
  const bool has_cracked = curve.back().n_cracks() > curve[record.first_row].n_cracks();
  const double risen = highest_stress - start.axial_stress;
  const double share = wanted.stop_stress_over_peak.value_or(0.5);
  const double last_strain = wanted.stop_strain_over_peak_strain * strain_at_highest;
  if (has_cracked && risen > 0.1 * (*running.axial_stress - start.axial_stress) &&
      (now.axial_stress <= start.axial_stress + share * risen ||
       (now.axial_strain >= last_strain && !is_rising(curve, record.first_row, wanted))))
    return give_up(fmt::format("the stress rose to {:.1f} MPa and no further", highest_stress / 1e6));
  return false;
}

std::string StageWalk::table() const
{
  std::string text;
  for (const LoadingStage& one : stages)
    text += full_text(one);
  return text;
}
} // namespace feldspar

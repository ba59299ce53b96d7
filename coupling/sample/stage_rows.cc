// A sample that follows the stages of a loading table, row by row. docs/theory.md §10.

#include "coupling/sample/running_sample.h"

#include <algorithm>
#include <cmath>

namespace feldspar
{
namespace
{
/// A row that is to end its stage aims so much beyond: a share of a row's step of strain, or of the stage's change of
/// stress. Round-off and Newton's tolerance would else leave it on this side.
constexpr double strain_beyond = 1e-6;
constexpr double width_beyond = 1e-3;
constexpr double stress_beyond = 1e-4;
constexpr double time_beyond = 1e-9;

/// Value on the way from one value towards another, by a step at most.
double towards(const double from, const double to, const double step)
{
  return from + std::clamp(to - from, -step, step);
}
} // namespace

StageMoment SampleTest::Parts::stage_moment() const
{
  const CurveSample& row = record.curve.back();
  return {row.time, -row.axial_strain, -row.axial_stress, -row.gauge_lateral_strain};
}

StageRow SampleTest::Parts::next_row_of_stage()
{
  const LoadingStage& stage = stage_walk->stage();
  const StageMoment& start = stage_walk->start_of_stage();
  const StageMoment now = stage_moment();
  const double step = sample.compression_step;
  const double rate = stage_walk->strain_rate();
  StageMoment then = now;
  StageRow row;
  if (stage.duration)
    then.time = std::min(now.time + step / rate, start.time + (1.0 + time_beyond) * *stage.duration);
  else if (stage.lateral_strain)
    {
      row.lead = StageRow::Lead::lateral_strain;
      then.lateral_strain = towards(now.lateral_strain, *stage.lateral_strain - width_beyond * step, step);
      then.time += std::abs(then.lateral_strain - now.lateral_strain) / rate;
    }
  else if (stage.axial_strain)
    {
      const double beyond = std::copysign(strain_beyond * step, *stage.axial_strain - start.axial_strain);
      then.axial_strain = towards(now.axial_strain, *stage.axial_strain + beyond, step);
      then.time += std::abs(then.axial_strain - now.axial_strain) / rate;
    }
  else
    {
      // Stiffness by the slope of the stage's last row; at its first row by the steepest slope so far, so that the row
      // does not go too far.
      const auto& curve = record.curve;
      const auto slope = [&](const std::size_t k) {
        return (curve[k].axial_stress - curve[k - 1].axial_stress) /
               (curve[k].axial_strain - curve[k - 1].axial_strain);
      };
      double stiffness = 0.0;
      if (curve.size() - 1 > stage_walk->records().back().first_row)
        stiffness = slope(curve.size() - 1);
      else
        for (std::size_t k = 1; k < curve.size(); ++k)
          if (std::isfinite(slope(k)))
            stiffness = std::max(stiffness, slope(k));
      constexpr double first_share = 0.01; // of a step, where nothing is known of the stiffness
      const double change = *stage.axial_stress - start.axial_stress;
      const double missing = *stage.axial_stress + stress_beyond * change - now.axial_stress;
      const double way = curve.size() == 1 ? first_share * step
                         : stiffness > 0.0 ? std::min(step, std::abs(missing) / stiffness)
                                           : step; // it softens
      then.axial_strain += std::copysign(way, change);
      then.time += way / rate;
    }
  const StageDemand demand = stage_walk->demand(then);
  row.confining_pressure = demand.confining_pressure;
  row.time = then.time;
  if (demand.held_stress)
    {
      row.lead = StageRow::Lead::stress;
      row.target = *demand.held_stress;
    }
  else if (row.lead == StageRow::Lead::lateral_strain)
    row.target = lateral_strain_at_seating - then.lateral_strain;
  else
    row.target = height_at_seating - then.axial_strain * size.height;
  return row;
}

void SampleTest::Parts::load_by_stage()
{
  if (!steps)
    {
      stage_row = next_row_of_stage();
      if (stage_row.lead == StageRow::Lead::stress)
        body->let_force_hold_platen();
    }
  go(stage_row);
}
} // namespace feldspar

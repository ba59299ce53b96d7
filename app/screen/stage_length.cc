#include "app/screen/stage_length.h"
#include "laboratory/compression.h"
#include "laboratory/loading_stages.h"

#include <algorithm>
#include <cmath>

namespace feldspar
{
StageLength::StageLength(const TestParameters& parameters, const double modulus_of_body)
  : wanted(parameters)
  , modulus(modulus_of_body)
  , walk(parameters)
{
  if (!wanted.of<LoadingTable>().stages.empty())
    now.axial_stress = wanted.of<LoadingTable>().stages.front().confining_pressure;
}

void StageLength::follow(const CurveSample& row)
{
  if (is_over || wanted.of<LoadingTable>().stages.empty())
    return;
  now = {row.time, -row.axial_strain, -row.axial_stress, -row.gauge_lateral_strain};
  rows.push_back(row);
  if (rows.size() > 1)
    is_over = walk.is_over(rows, now);
  else
    {
      time_at_start = row.time;
      walk.begin(now);
    }
}

double StageLength::gone() const { return strain_of(now.time - time_at_start); }

double StageLength::left() const
{
  if (is_over)
    return 0.0;
  const std::size_t n_begun = walk.records().size();
  StageMoment at = now;
  double time = n_begun > 0 && walk.stage().duration ? walk.start_of_stage().time - now.time : 0.0;
  for (std::size_t k = std::max<std::size_t>(n_begun, 1) - 1; k < wanted.of<LoadingTable>().stages.size(); ++k)
    time += way(wanted.of<LoadingTable>().stages[k], at);
  return strain_of(std::max(0.0, time));
}

double StageLength::way(const LoadingStage& stage, StageMoment& from) const
{
  constexpr double widening_over_shortening = 0.25; // of rock that carries load
  const double rate = stage.strain_rate.value_or(wanted.of<CompressionParameters>().strain_rate);
  double strain = 0.0;
  double time = 0.0;
  if (stage.duration)
    time = *stage.duration;
  else if (stage.lateral_strain)
    {
      strain = std::max(0.0, from.lateral_strain - *stage.lateral_strain) / widening_over_shortening;
      time = strain * widening_over_shortening / rate;
    }
  else
    {
      strain = stage.axial_strain ? *stage.axial_strain - from.axial_strain
                                  : (*stage.axial_stress - from.axial_stress) / modulus;
      time = std::abs(strain) / rate;
    }
  from.axial_strain += strain;
  from.axial_stress = stage.axial_stress.value_or(std::max(0.0, from.axial_stress + strain * modulus));
  from.lateral_strain -= widening_over_shortening * strain;
  return time;
}
} // namespace feldspar

#include "laboratory/paired_moments.h"
#include "results/evaluation.h"

#include <algorithm>

namespace feldspar
{
namespace
{
Figure slope_of(const TestRecord& record, const StageRecord& stage)
{
  std::vector<double> strain, stress;
  for (std::size_t k = stage.first_row; k <= stage.last_row; ++k)
    {
      strain.push_back(record.kind.strain(record.curve[k]));
      stress.push_back(record.kind.stress(record.curve[k]));
    }
  if (strain.size() < 3)
    return {std::nullopt, "fewer than three rows of the curve in the stage: choose a smaller sampling strain"};
  const auto [low, high] = std::ranges::minmax_element(strain);
  if (*low == *high)
    return {std::nullopt, "the platens stand still"};
  return {paired_moments(strain, stress).slope(), ""};
}
} // namespace

std::vector<StageResults> evaluate_stages(const TestRecord& record)
{
  std::vector<StageResults> all;
  for (const StageRecord& stage : record.stages)
    {
      const CurveSample& first = record.curve.at(stage.first_row);
      const CurveSample& last = record.curve.at(stage.last_row);
      StageResults results;
      results.strain_at_start = record.kind.strain(first) + 0.0; // no -0
      results.strain_at_end = record.kind.strain(last);
      results.stress_at_start = record.kind.stress(first);
      results.stress_at_end = record.kind.stress(last);
      results.lateral_stress_at_end =
        stage.confining_pressure > 0.0 ? Figure{-last.lateral_stress, ""} : Figure{std::nullopt, "no side walls"};
      results.slope = slope_of(record, stage);
      results.n_cracks = last.n_cracks() - first.n_cracks();
      results.duration = last.time - first.time;
      all.push_back(results);
    }
  return all;
}
} // namespace feldspar

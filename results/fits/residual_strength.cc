#include "results/fits/residual_strength.h"

#include "results/runs/test_groups.h"
#include "results/statistics.h"

#include <cmath>
#include <numeric>

namespace feldspar
{
namespace
{
constexpr double share_of_the_branch = 1.0 / 3.0;
constexpr double most_change = 0.1; // of the peak deviator
constexpr double most_left = 0.95;  // the same
constexpr std::size_t fewest_rows = 10;

double mean(const std::vector<double>::const_iterator begin, const std::vector<double>::const_iterator end)
{
  return std::accumulate(begin, end, 0.0) / double(end - begin);
}

Figure none(const std::string& reason) { return {std::nullopt, reason}; }
} // namespace

Figure residual_strength(const TestRecord& record)
{
  const auto peak = peak_row(record);
  if (!peak)
    return none("the stress never peaked");
  const auto strain = [&](const CurveSample& row) { return record.kind.strain(row); };
  const double end = strain(record.curve.back());
  const double begin = end - share_of_the_branch * (end - strain(record.curve[*peak]));
  std::vector<double> deviators;
  for (std::size_t k = *peak; k < record.curve.size(); ++k)
    if (strain(record.curve[k]) >= begin)
      deviators.push_back(record.kind.deviator(record.curve[k], record.confining_pressure));
  if (deviators.size() < fewest_rows)
    return none("too few rows after the peak");
  const double at_peak = record.kind.deviator(record.curve[*peak], record.confining_pressure);
  const double whole = mean(deviators.begin(), deviators.end());
  const auto middle = deviators.begin() + std::ptrdiff_t(deviators.size() / 2);
  if (whole > most_left * at_peak)
    return none("the stress did not fall");
  if (std::abs(mean(deviators.begin(), middle) - mean(middle, deviators.end())) > most_change * at_peak)
    return none("the stress was still changing when the test ended");
  return {whole + (record.kind.pressure_acts_across ? 0.0 : record.confining_pressure), ""};
}

std::vector<ResidualPoint> residual_points(const Series& series)
{
  std::vector<ResidualPoint> points;
  for (const auto& group : groups_of(series))
    if (group.envelope_role() == EnvelopeRole::compression)
      {
        std::vector<double> strengths;
        for (const auto* test : group.tests)
          if (const Figure one = residual_strength(test->record); one.value)
            strengths.push_back(*one.value);
        if (const auto over_seeds = statistics(strengths); over_seeds && 2 * over_seeds->n >= group.tests.size())
          points.push_back({group.confining_pressure, over_seeds->mean, over_seeds->standard_deviation.value_or(0.0)});
      }
  return points;
}
} // namespace feldspar

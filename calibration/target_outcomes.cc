#include "calibration/target_outcomes.h"

#include "base/mapped.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace feldspar::calibration
{
namespace
{
std::string in_words(const TargetOutcome& outcome, const ResponseModel& model)
{
  const Response& response = model.response(outcome.target.response);
  const auto& [unit, scale, decimals] = response.shown;
  return fmt::format("{} {:.{}f}{}{} ({:+.1f} %)", response.title, outcome.value() / scale, decimals,
                     unit.empty() ? "" : " ", unit, 100.0 * outcome.deviation());
}

/// Shares of the target.
std::optional<double> share(const TargetOutcome& outcome, std::optional<double> Statistics::*figure)
{
  const auto value = outcome.reached ? *outcome.reached.*figure : std::nullopt;
  return value ? std::optional(*value / std::abs(outcome.target.value)) : std::nullopt;
}
} // namespace

std::vector<TargetOutcome> outcomes_of(const std::vector<TestedPoint>& points, const std::vector<Target>& targets,
                                       const ResponseModel& model, const Place& place)
{
  std::vector<TargetOutcome> outcomes;
  for (const Target& target : targets)
    {
      std::vector<double> values;
      for (const TestedPoint& one : points)
        if (one.values[target.response])
          values.push_back(*one.values[target.response]);
      outcomes.push_back(
        {target, statistics(values), model.response(target.response).in_si(model.predict(target.response, place))});
    }
  return outcomes;
}

std::vector<TargetOutcome> predicted_outcomes(const std::vector<Target>& targets, const Fit& fit,
                                              const ResponseModel& model, const double tolerance,
                                              const std::size_t n_packings)
{
  constexpr double errors_apart = 3.0;
  std::vector<TargetOutcome> outcomes;
  for (std::size_t t = 0; t < targets.size(); ++t)
    {
      const Target& target = targets[t];
      const double error = std::hypot(model.deviation(target.response, fit.place.point),
                                      model.learnt(target.response).noise / std::sqrt(double(n_packings))) /
                           model.response(target.response).per_share(target.value);
      const bool is_out_of_reach =
        std::abs(fit.deviations[t]) > errors_apart * error + std::max(tolerance, 2.0 * target.deviation / target.value);
      outcomes.push_back({target, std::nullopt, target.value * (1.0 + fit.deviations[t]), is_out_of_reach});
    }
  return outcomes;
}

TargetMean mean_of(const TargetOutcome& outcome, const std::string& title)
{
  return {title, outcome.deviation(), share(outcome, &Statistics::standard_error),
          outcome.reached ? outcome.reached->n : 0};
}

TargetVerdict verdict_on(const TargetOutcome& outcome, const double tolerance)
{
  if (outcome.is_out_of_reach)
    return TargetVerdict::missed;
  return feldspar::verdict_on(mean_of(outcome, ""), tolerance);
}

TargetVerdict verdict_on(const std::vector<TargetOutcome>& outcomes, const double tolerance)
{
  return feldspar::verdict_on(
    mapped<TargetVerdict>(outcomes, [&](const TargetOutcome& outcome) { return verdict_on(outcome, tolerance); }));
}

bool is_nearly_met(const TargetOutcome& outcome, const double tolerance)
{
  return outcome.reached && std::abs(outcome.deviation()) <=
                              std::max(0.5 * tolerance, share(outcome, &Statistics::standard_error).value_or(0.0));
}

std::size_t packings_needed(const std::vector<TargetOutcome>& outcomes, const double tolerance, const std::size_t most)
{
  std::size_t needed = 0;
  for (const TargetOutcome& outcome : outcomes)
    {
      const auto scatter = share(outcome, &Statistics::standard_deviation);
      needed = std::max(needed, scatter ? packings_for(wanted_half_width(tolerance), *scatter).value_or(most) : most);
    }
  return std::min(needed, most);
}

bool is_worth_another_round(const std::vector<TargetOutcome>& outcomes, const double tolerance)
{
  const TargetVerdict verdict = verdict_on(outcomes, tolerance);
  return verdict == TargetVerdict::missed ||
         (verdict == TargetVerdict::not_decided && std::ranges::all_of(outcomes, [&](const TargetOutcome& outcome) {
            const auto half_width = share(outcome, &Statistics::confidence_95);
            return half_width && *half_width <= tolerance;
          }));
}

std::string nearest_in_words(const std::vector<TargetOutcome>& outcomes, const ResponseModel& model)
{
  const auto words =
    mapped<std::string>(outcomes, [&](const TargetOutcome& outcome) { return in_words(outcome, model); });
  return fmt::format("these targets cannot be reached together between the bounds of section Calibration; nearest come "
                     "{}",
                     fmt::join(words, "; ")); // titles have commas of their own
}

std::string statement_of(const std::vector<TargetOutcome>& outcomes, const ResponseModel& model, const double tolerance)
{
  const auto mean = [&](const TargetOutcome& outcome) {
    return mean_of(outcome, model.response(outcome.target.response).title);
  };
  return statement_on(mapped<TargetMean>(outcomes, mean), tolerance);
}
} // namespace feldspar::calibration

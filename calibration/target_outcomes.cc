#include "calibration/target_outcomes.h"

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
  return fmt::format("{} {:.{}f}{} ({:+.1f} %)", response.title, outcome.value() / response.unit_size,
                     response.decimals, response.unit.empty() ? "" : " " + response.unit, 100.0 * outcome.deviation());
}

/// As a share of the target.
double standard_error(const TargetOutcome& outcome)
{
  return outcome.reached ? outcome.reached->standard_error.value_or(0.0) / std::abs(outcome.target.value) : 0.0;
}

/// Titles have commas of their own.
std::string listed(const std::vector<std::string>& words) { return fmt::format("{}", fmt::join(words, "; ")); }
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

std::vector<TargetOutcome> predicted_outcomes(const std::vector<Target>& targets, const Fit& fit)
{
  std::vector<TargetOutcome> outcomes;
  for (std::size_t t = 0; t < targets.size(); ++t)
    outcomes.push_back({targets[t], std::nullopt, targets[t].value * (1.0 + fit.deviations[t])});
  return outcomes;
}

bool is_met(const TargetOutcome& outcome, const double tolerance)
{
  return outcome.reached && std::abs(outcome.deviation()) <= std::max(tolerance, 2.0 * standard_error(outcome));
}

bool all_met(const std::vector<TargetOutcome>& outcomes, const double tolerance)
{
  return std::all_of(outcomes.begin(), outcomes.end(), [&](const auto& outcome) { return is_met(outcome, tolerance); });
}

bool is_nearly_met(const TargetOutcome& outcome, const double tolerance)
{
  return outcome.reached && std::abs(outcome.deviation()) <= std::max(0.5 * tolerance, standard_error(outcome));
}

std::size_t packings_needed(const std::vector<TargetOutcome>& outcomes, const double tolerance)
{
  constexpr double no_more = 1e6;
  double needed = 0.0;
  for (const TargetOutcome& outcome : outcomes)
    if (outcome.reached && outcome.reached->standard_deviation)
      needed = std::max(
        needed, std::pow(*outcome.reached->standard_deviation / (0.5 * tolerance * std::abs(outcome.target.value)), 2));
  return std::size_t(std::min(std::ceil(needed), no_more));
}

bool is_out_of_reach(const Fit& fit, const std::vector<Target>& targets, const ResponseModel& model,
                     const double tolerance, const std::size_t n_packings)
{
  constexpr double errors_apart = 3.0;
  for (std::size_t t = 0; t < targets.size(); ++t)
    {
      const Target& target = targets[t];
      const double error = std::hypot(model.deviation(target.response, fit.place.point),
                                      model.noise(target.response) / std::sqrt(double(n_packings))) /
                           model.response(target.response).per_share(target.value);
      if (std::abs(fit.deviations[t]) >
          errors_apart * error + std::max(tolerance, 2.0 * target.deviation / target.value))
        return true;
    }
  return false;
}

std::string nearest_in_words(const std::vector<TargetOutcome>& outcomes, const ResponseModel& model)
{
  std::vector<std::string> words;
  for (const TargetOutcome& outcome : outcomes)
    words.push_back(in_words(outcome, model));
  return fmt::format("these targets cannot be reached together between the bounds of section Calibration; nearest come "
                     "{}",
                     listed(words));
}

std::string statement_of(const std::vector<TargetOutcome>& outcomes, const ResponseModel& model, const double tolerance,
                         const std::size_t n_steps)
{
  std::vector<std::string> missed;
  std::vector<std::string> uncertain;
  for (const TargetOutcome& outcome : outcomes)
    if (!is_met(outcome, tolerance))
      missed.push_back(in_words(outcome, model));
    else if (standard_error(outcome) > 0.5 * tolerance)
      uncertain.push_back(model.response(outcome.target.response).title);
  if (!missed.empty())
    return fmt::format("the targets were not all reached after {} step{}; off by more than the tolerance of {:g} %: {}",
                       n_steps, n_steps == 1 ? "" : "s", 100.0 * tolerance, listed(missed));
  std::string text = fmt::format("All targets were reached within {:g} %", 100.0 * tolerance);
  if (!uncertain.empty())
    text +=
      fmt::format(" or within two standard errors, but the scatter of packings left standard errors above half of that "
                  "({}): raise Calibration/Most packings, or test larger specimens",
                  listed(uncertain));
  return text + ".";
}
} // namespace feldspar::calibration

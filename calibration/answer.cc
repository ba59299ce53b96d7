#include "calibration/answer.h"

#include "base/contains.h"
#include "base/prefixes.h"
#include "calibration/open_turns.h"
#include "laboratory/paired_moments.h"

#include <Eigen/Cholesky>
#include <Eigen/LU>
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>

namespace feldspar::calibration
{
namespace
{
/// Coordinates of the posterior's walk: the unknowns, then those scales that are free.
class Coordinates
{
public:
  Coordinates(const std::size_t n_unknowns, const FitFreedom& freedom, const Place& start)
    : n(n_unknowns)
    , fixed(start)
  {
    if (freedom.modulus)
      scales.push_back(&Place::log_modulus);
    if (freedom.strength)
      scales.push_back(&Place::log_strength);
  }

  std::vector<double> of(const Place& place) const
  {
    std::vector<double> x = place.point;
    for (const auto scale : scales)
      x.push_back(place.*scale);
    return x;
  }

  Place place(const std::vector<double>& x) const
  {
    Place result = fixed;
    result.point.assign(x.begin(), x.begin() + std::ptrdiff_t(n));
    for (std::size_t k = 0; k < scales.size(); ++k)
      result.*scales[k] = x[n + k];
    return result;
  }

private:
  std::size_t n;
  Place fixed;
  std::vector<double Place::*> scales;
};

/// Variance of the difference between prediction and target, in the model's measure.
double variance(const ResponseModel& model, const Target& target, const UnitPoint& point)
{
  const double of_rock = target.deviation / target.value * model.response(target.response).per_share(target.value);
  return std::pow(of_rock, 2) + std::pow(model.deviation(target.response, point), 2);
}

double log_density(const ResponseModel& model, const std::vector<Target>& targets, const Place& place)
{
  double sum = 0.0;
  for (const Target& target : targets)
    {
      const double spread = variance(model, target, place.point);
      const double difference =
        model.predict(target.response, place) - model.response(target.response).in_model(target.value);
      sum -= 0.5 * (difference * difference / spread + std::log(spread));
    }
  return sum;
}

/// Covariance of the normal distribution that is near the posterior at its best place: (Jᵀ W J + prior)⁻¹, by central
/// differences.
Eigen::MatrixXd nearby_covariance(const ResponseModel& model, const std::vector<Target>& targets,
                                  const Coordinates& coordinates, const Place& best)
{
  const std::vector<double> centre = coordinates.of(best);
  const auto n = Eigen::Index(centre.size());
  Eigen::VectorXd prior = Eigen::VectorXd::Ones(n);                    // a factor of e
  prior.head(Eigen::Index(model.unknowns().size())).setConstant(12.0); // even over the unit
  Eigen::MatrixXd information = prior.asDiagonal();
  for (const Target& target : targets)
    {
      Eigen::VectorXd slope(n);
      for (std::size_t k = 0; k < centre.size(); ++k)
        {
          constexpr double step = 1e-3;
          std::vector<double> x = centre;
          x[k] += step;
          const double above = model.predict(target.response, coordinates.place(x));
          x[k] -= 2.0 * step;
          slope[Eigen::Index(k)] = (above - model.predict(target.response, coordinates.place(x))) / (2.0 * step);
        }
      information += slope * slope.transpose() / variance(model, target, best.point);
    }
  return information.inverse();
}

double correlation(const std::vector<double>& a, const std::vector<double>& b)
{
  const PairedMoments of = paired_moments(a, b);
  return of.xx > 0.0 && of.yy > 0.0 ? of.xy / std::sqrt(of.xx * of.yy) : 0.0;
}

/// The share of what the bounds allow. A scale has no bounds: its own range is taken as a factor of two to each side.
double share_of_bounds(const ParameterAnswer& answer)
{
  constexpr double middle_90 = 0.9; // of an even distribution
  const auto measure = [&](const double value) { return answer.logarithmic ? std::log(value) : value; };
  const double range =
    answer.bounds ? measure(answer.bounds->upper) - measure(answer.bounds->lower) : 2.0 * std::numbers::ln2;
  return (measure(answer.upper_90) - measure(answer.lower_90)) / (middle_90 * range);
}

Determination determination_of(const double share)
{
  constexpr double of_determined = 0.25;
  constexpr double of_bounded = 0.75;
  return share <= of_determined ? Determination::determined
         : share <= of_bounded  ? Determination::bounded
                                : Determination::not_determined;
}

/// Value in the unit of tables, to three figures.
std::string shown(const ParameterAnswer& answer, const double value)
{
  return fmt::format("{:.3g}", value / answer.unit_size);
}

std::string sentence_of(const ParameterAnswer& answer, const std::string& helpful_title, const bool has_confined_tests)
{
  const std::string unit = answer.unit.empty() ? "" : " " + answer.unit;
  std::string text =
    fmt::format("The {} is {} by these tests: 90 % of what agrees with them lies between {} and {}{}", answer.title,
                words(answer.verdict), shown(answer, answer.lower_90), shown(answer, answer.upper_90), unit);
  if (answer.verdict == Determination::determined)
    return text + ".";
  if (!helpful_title.empty())
    return text + fmt::format("; a measured {} would help most.", helpful_title);
  text += "; no other test of the programme would tell more of it.";
  return has_confined_tests ? text : text + " The programme has no triaxial compression; one may tell more.";
}
} // namespace

std::string words(const Determination verdict)
{
  return verdict == Determination::determined ? "determined"
         : verdict == Determination::bounded  ? "bounded"
                                              : "not determined";
}

std::string ParameterAnswer::si_unit() const { return unit.empty() ? "1" : unit == "deg" ? "rad" : "Pa"; }

std::vector<ParameterAnswer> reported_parameters(const std::vector<Unknown>& unknowns, const bool modulus,
                                                 const bool strength)
{
  std::vector<ParameterAnswer> all;
  if (modulus)
    all.push_back({"modulus", "modulus", "GPa", giga, [](const MicroParameters& p) { return p.modulus; }});
  if (strength)
    all.push_back({"bond_tensile_strength", "bond tensile strength", "MPa", mega,
                   [](const MicroParameters& p) { return p.bond_tensile_strength; }});
  bool has_cohesion = strength;
  for (const Unknown& unknown : unknowns)
    {
      all.push_back({unknown.name, unknown.title, unknown.unit, unknown.unit_size,
                     [unknown](const MicroParameters& p) { return unknown.of(p); }, unknown.bounds,
                     unknown.logarithmic});
      has_cohesion |= unknown.name == "cohesion_ratio";
    }
  if (has_cohesion)
    all.push_back({"bond_cohesion", "bond cohesion", "MPa", mega,
                   [](const MicroParameters& p) { return p.cohesion_ratio * p.bond_tensile_strength; }});
  return all;
}

double quantile(std::vector<double> values, const double share)
{
  std::ranges::sort(values);
  const double place = share * double(values.size() - 1);
  const auto below = std::size_t(place);
  const std::size_t above = std::min(below + 1, values.size() - 1);
  return values[below] + (place - double(below)) * (values[above] - values[below]);
}

Posterior posterior(const ResponseModel& model, const std::vector<Target>& targets, const FitFreedom& freedom,
                    const Place& best, const std::size_t n_samples, const std::uint64_t seed)
{
  const std::size_t n_unknowns = model.unknowns().size();
  const Coordinates coordinates(n_unknowns, freedom, best);
  std::vector<double> start = coordinates.of(best);
  std::vector<double> lower(n_unknowns, 0.0);
  std::vector<double> upper(n_unknowns, 1.0);
  constexpr double far = 3.0; // a factor of 20 to each side
  for (std::size_t k = n_unknowns; k < start.size(); ++k)
    {
      lower.push_back(start[k] - far);
      upper.push_back(start[k] + far);
    }
  constexpr double off_the_bounds = 1e-6;
  for (std::size_t k = 0; k < n_unknowns; ++k)
    start[k] = std::clamp(start[k], off_the_bounds, 1.0 - off_the_bounds);

  Posterior result;
  for (const auto& x :
       metropolis([&](const auto& at) { return log_density(model, targets, coordinates.place(at)); }, lower, upper,
                  start, nearby_covariance(model, targets, coordinates, best), n_samples, seed))
    result.samples.push_back(coordinates.place(x));

  std::vector<std::vector<double>> responses(model.n_responses()); // in the model's measure
  for (std::size_t j = 0; j < model.n_responses(); ++j)
    if (model.knows(j))
      {
        for (const Place& place : result.samples)
          responses[j].push_back(model.predict(j, place));
        const Response& response = model.response(j);
        // The surrogate's own error, taken at the best place.
        constexpr double normal_90 = 1.644854;
        const double error = normal_90 * model.deviation(j, best.point);
        const double median = quantile(responses[j], 0.5);
        const double below = std::hypot(median - quantile(responses[j], 0.05), error);
        const double above = std::hypot(quantile(responses[j], 0.95) - median, error);
        result.predictions.push_back(
          {j, response.in_si(median), response.in_si(median - below), response.in_si(median + above)});
      }

  bool has_confined_tests = false;
  for (std::size_t j = 0; j < model.n_responses(); ++j)
    has_confined_tests |= model.response(j).name.starts_with("strength_at_");
  const MicroParameters at_best = model.parameters(best);
  for (ParameterAnswer& answer : reported_parameters(model.unknowns(), freedom.modulus, freedom.strength))
    {
      std::vector<double> values;
      std::vector<double> measured;
      for (const Place& place : result.samples)
        {
          values.push_back(answer.value(model.parameters(place)));
          measured.push_back(answer.logarithmic ? std::log(values.back()) : values.back());
        }
      answer.best = answer.value(at_best);
      answer.median = quantile(values, 0.5);
      answer.lower_90 = quantile(values, 0.05);
      answer.upper_90 = quantile(values, 0.95);
      answer.share_of_bounds = share_of_bounds(answer);
      answer.verdict = determination_of(answer.share_of_bounds);
      // A test helps by what it shares with the parameter, less what its own error of measurement would hide.
      double most = 0.1; // of the variance; less is no help
      std::string helpful_title;
      for (std::size_t j = 0; j < model.n_responses(); ++j)
        {
          const bool is_target = contains(targets, j, &Target::response);
          if (is_target || responses[j].empty())
            continue;
          const double error = model.deviation(j, best.point);
          double spread = 0.0;
          const double middle = quantile(responses[j], 0.5);
          for (const double value : responses[j])
            spread += (value - middle) * (value - middle) / double(responses[j].size());
          const double told =
            std::pow(correlation(measured, responses[j]), 2) * spread / std::max(spread + error * error, 1e-30);
          if (told > most)
            {
              most = told;
              answer.helpful_test = model.response(j).name;
              helpful_title = model.response(j).title;
            }
        }
      answer.sentence = sentence_of(answer, helpful_title, has_confined_tests);
      result.parameters.push_back(std::move(answer));
    }
  return result;
}
} // namespace feldspar::calibration

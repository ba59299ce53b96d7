#include "calibration/responses.h"

#include "base/prefixes.h"

#include "base/input_error.h"
#include "results/fits/hoek_brown.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace feldspar::calibration
{
namespace
{

Figure TestResults::*figure_of(const ElasticFigure which, Figure TestResults::*tangent, Figure TestResults::*initial,
                               Figure TestResults::*secant)
{
  return which == ElasticFigure::tangent ? tangent : which == ElasticFigure::initial ? initial : secant;
}

std::string words(const ElasticFigure which)
{
  return which == ElasticFigure::tangent   ? "tangent 40-60 % of peak"
         : which == ElasticFigure::initial ? "initial"
                                           : "secant at 50 % of peak";
}

/// Of the test of one case.
std::function<std::optional<double>(const std::vector<FinishedTest>&)> figure(const TestCase& of,
                                                                              Figure TestResults::*which)
{
  return [of, which](const std::vector<FinishedTest>& of_specimen) -> std::optional<double> {
    for (const FinishedTest& test : of_specimen)
      if (test.counts() && test.record.kind == of.kind && test.record.confining_pressure == of.confining_pressure)
        return (test.results.*which).value;
    return std::nullopt;
  };
}

/// m_i by all tests in compression; none where one of them broke down.
std::optional<double> rock_constant_of(const std::vector<FinishedTest>& of_specimen)
{
  std::vector<EnvelopePoint> points;
  for (const FinishedTest& test : of_specimen)
    if (test.record.envelope_role() == EnvelopeRole::compression)
      {
        if (!test.was_made() || !test.results.peak_stress.value)
          return std::nullopt;
        points.push_back({test.record.confining_pressure, *test.results.peak_stress.value});
      }
  return rock_constant(points);
}

bool gives_rock_constant(const std::vector<TestCase>& programme)
{
  const auto has = [&](const bool confined) {
    return std::any_of(programme.begin(), programme.end(), [&](const TestCase& test) {
      return test.kind.envelope_role == EnvelopeRole::compression && test.kind.takes_confining_pressure == confined;
    });
  };
  return has(false) && has(true);
}

/// How far the mean of the rock may lie from the figure of the reference, and by what.
void set_deviation(Target& target, const ReferenceValue& given, const double tolerance)
{
  if (given.standard_deviation && given.n)
    {
      target.deviation = *given.standard_deviation / std::sqrt(double(*given.n));
      target.source = fmt::format("standard error of {} tests", *given.n);
    }
  else if (given.standard_deviation)
    {
      target.deviation = *given.standard_deviation;
      target.source = "standard deviation of an unknown number of tests";
    }
  else if (given.low && given.high && *given.high > *given.low)
    {
      target.deviation = 0.25 * (*given.high - *given.low);
      target.source = "a quarter of the range";
    }
  else
    {
      target.deviation = tolerance * std::abs(target.value);
      target.source = "the tolerance, for want of a range or a standard deviation";
    }
}
} // namespace

double Response::in_model(const double si_value) const
{
  return scale == ResponseScale::none ? si_value : std::log(si_value);
}

double Response::in_si(const double model_value) const
{
  return scale == ResponseScale::none ? model_value : std::exp(model_value);
}

std::vector<Response> responses(const std::vector<TestCase>& programme, const CalibrationParameters& wanted)
{
  std::vector<Response> all;
  const auto strength = [&](const TestCase& test, const std::string& name, const std::string& title,
                            Figure TestResults::*which, const int decimals) {
    all.push_back({name, title, "MPa", mega, decimals, name.ends_with("_MPa") ? name : name + "_MPa", mega,
                   ResponseScale::strength, figure(test, which)});
  };
  // In the plane an elastic body could have up to one; specimens that do not crack have a third at most.
  constexpr double largest_elastic_ratio = 0.5;
  const bool is_initial = wanted.poissons_ratio == ElasticFigure::initial;
  for (const TestCase& test : programme)
    switch (test.kind.envelope_role)
      {
      case EnvelopeRole::tension:
        strength(test, "tensile_strength", "tensile strength", &TestResults::peak_stress, 2);
        break;
      case EnvelopeRole::indirect_tension:
        strength(test, "brazilian_strength", "Brazilian strength", &TestResults::peak_stress, 2);
        break;
      case EnvelopeRole::compression:
        if (test.kind.takes_confining_pressure)
          {
            const std::string pressure = fmt::format("{:g}", std::round(test.confining_pressure) / mega);
            strength(test, "strength_at_" + pressure + "_MPa", "strength at " + pressure + " MPa confinement",
                     &TestResults::peak_stress, 1);
            break;
          }
        all.push_back(
          {"youngs_modulus", "Young's modulus, " + words(wanted.youngs_modulus), "GPa", giga, 1, "youngs_modulus_GPa",
           giga, ResponseScale::modulus,
           figure(test, figure_of(wanted.youngs_modulus, &TestResults::youngs_modulus_tangent,
                                  &TestResults::youngs_modulus_initial, &TestResults::youngs_modulus_secant))});
        all.push_back(
          {"poissons_ratio", "Poisson's ratio, " + words(wanted.poissons_ratio), "", 1.0, 3, "poissons_ratio", 1.0,
           ResponseScale::none,
           figure(test, is_initial ? &TestResults::poissons_ratio_initial : &TestResults::poissons_ratio_secant),
           is_initial ? std::optional(largest_elastic_ratio) : std::nullopt});
        strength(test, "uniaxial_compressive_strength", "uniaxial compressive strength", &TestResults::peak_stress, 1);
        strength(test, "crack_initiation_stress", "crack initiation stress", &TestResults::crack_initiation_stress, 1);
        strength(test, "crack_damage_stress", "crack damage stress", &TestResults::crack_damage_stress, 1);
        break;
      case EnvelopeRole::none:
        break;
      }
  if (gives_rock_constant(programme))
    all.push_back({"m_i", "m_i of Hoek and Brown", "", 1.0, 1, "m_i", 1.0, ResponseScale::ratio, rock_constant_of});
  return all;
}

std::vector<std::optional<double>> values_of(const std::vector<Response>& responses,
                                             const std::vector<FinishedTest>& of_specimen)
{
  std::vector<std::optional<double>> values;
  for (const Response& response : responses)
    {
      std::optional<double> value = response.value(of_specimen);
      if (value && response.scale != ResponseScale::none && !(*value > 0.0))
        value.reset(); // no logarithm
      values.push_back(value);
    }
  return values;
}

std::vector<Target> targets(const std::vector<Response>& responses, const Reference& reference,
                            const CalibrationParameters& wanted)
{
  const auto given = [&](const Response& response) {
    return reference.experiment.find(response.reference_key, 1.0 / response.reference_unit);
  };
  for (const std::string& name : wanted.targets)
    {
      const auto found =
        std::find_if(responses.begin(), responses.end(), [&](const Response& one) { return one.name == name; });
      if (found == responses.end())
        {
          std::string known;
          for (const Response& one : responses)
            known += (known.empty() ? "" : ", ") + one.name;
          throw InputError(
            fmt::format("Calibration/Targets: no test of Tests/List gives {}; they give {}", name, known));
        }
      if (!given(*found))
        throw InputError(
          fmt::format("Calibration/Targets: the experiment of the reference file has no {}", found->reference_key));
    }
  std::vector<Target> all;
  for (std::size_t j = 0; j < responses.size(); ++j)
    if (const auto value = given(responses[j]);
        value && (wanted.targets.empty() ||
                  std::find(wanted.targets.begin(), wanted.targets.end(), responses[j].name) != wanted.targets.end()))
      {
        Target target{j, value->middle(), 0.0, ""};
        if (!(target.value > 0.0))
          throw InputError(
            fmt::format("{} of the reference file: is {:g}; a target must be above 0, because deviations "
                        "are shares of it",
                        responses[j].reference_key, target.value / responses[j].reference_unit));
        set_deviation(target, *value, wanted.tolerance);
        all.push_back(target);
      }
  if (all.empty())
    throw InputError("Report/Reference file: its experiment has none of the figures that the tests of Tests/List give");
  return all;
}
} // namespace feldspar::calibration

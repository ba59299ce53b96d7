#include "calibration/responses.h"

#include "base/append.h"
#include "base/contains.h"
#include "base/input_error.h"
#include "base/mapped.h"
#include "base/prefixes.h"
#include "laboratory/named_entries.h"
#include "results/fits/hoek_brown.h"
#include "results/quantities.h"

#include <fmt/ranges.h>

#include <algorithm>

namespace feldspar::calibration
{
namespace
{
/// Name of the figure in the table of properties.
std::string_view name(const ElasticFigure which)
{
  return which == ElasticFigure::tangent ? "tangent" : which == ElasticFigure::initial ? "initial" : "secant";
}

/// Function that takes a figure from the test of one case.
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
    return std::ranges::any_of(programme, [&](const TestCase& test) {
      return test.kind.envelope_role == EnvelopeRole::compression && test.kind.takes_confining_pressure == confined;
    });
  };
  return has(false) && has(true);
}

/// Sets how far the mean of the rock may lie from the figure of the reference, and the source of this deviation.
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

std::vector<Response> responses(const std::vector<TestCase>& programme, const CalibrationParameters& wanted)
{
  // In the plane an elastic body could have up to one; specimens that do not crack have a third at most.
  constexpr double largest_elastic_ratio = 0.5;
  const auto is_chosen = [&](const RockProperty& property) {
    return property.choice.name.empty() ||
           property.choice.name ==
             name(property.scale == ResponseScale::modulus ? wanted.youngs_modulus : wanted.poissons_ratio);
  };
  std::vector<Response> all;
  for (const TestCase& test : programme)
    {
      std::vector<Response> of_test;
      for (const RockProperty& property : rock_properties)
        if (property.scale && gives(property.source, test.kind) && is_chosen(property))
          {
            of_test.push_back({std::string(property.target()), std::string(property.title), property.shown,
                               std::string(property.key), *property.scale, figure(test, property.figure)});
            if (property.figure == &TestResults::poissons_ratio_initial)
              of_test.back().largest_in_design = largest_elastic_ratio;
          }
      if (test.kind.envelope_role == EnvelopeRole::compression && test.kind.takes_confining_pressure)
        {
          const std::string pressure = fmt::format("{:g}", std::round(test.confining_pressure) / mega);
          const std::string key = "strength_at_" + pressure + "_MPa";
          of_test.push_back({key, "strength at " + pressure + " MPa confinement", display::megapascals(), key,
                             ResponseScale::strength, figure(test, &TestResults::peak_stress)});
        }
      // Elastic constants before strengths.
      std::stable_partition(of_test.begin(), of_test.end(),
                            [](const Response& one) { return one.scale != ResponseScale::strength; });
      append(all, std::move(of_test));
    }
  if (gives_rock_constant(programme))
    {
      constexpr RockProperty property = rock_property("m_i");
      all.push_back({std::string(property.target()), std::string(property.title), property.shown,
                     std::string(property.key), *property.scale, rock_constant_of});
    }
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
    return reference.experiment.find(response.reference_key, 1.0 / response.shown.scale);
  };
  for (const std::string& name : wanted.targets)
    {
      const auto found = std::ranges::find(responses, name, &Response::name);
      if (found == responses.end())
        {
          throw InputError("{}: no test of {} gives {}; they give {}", input_entries::targets.text(),
                           input_entries::test_list.text(), name,
                           fmt::join(mapped<std::string>(responses, &Response::name), ", "));
        }
      if (!given(*found))
        throw InputError("{}: the experiment of the reference file has no {}", input_entries::targets.text(),
                         found->reference_key);
    }
  std::vector<Target> all;
  for (std::size_t j = 0; j < responses.size(); ++j)
    if (const auto value = given(responses[j]);
        value && (wanted.targets.empty() || contains(wanted.targets, responses[j].name)))
      {
        Target target{j, value->middle(), 0.0, ""};
        if (!(target.value > 0.0))
          throw InputError("{} of the reference file: is {:g}; a target must be above 0, because deviations "
                           "are shares of it",
                           responses[j].reference_key, target.value / responses[j].shown.scale);
        set_deviation(target, *value, wanted.tolerance);
        all.push_back(target);
      }
  if (all.empty())
    throw InputError("{}: its experiment has none of the figures that the tests of {} give",
                     input_entries::reference_file.text(), input_entries::test_list.text());
  return all;
}
} // namespace feldspar::calibration

#include "results/runs/trust.h"

#include "results/statistics.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <set>
#include <utility>

namespace feldspar
{
namespace
{
using Value = std::optional<double>;

/// The specimen tells of its width; a beam is longer than it is deep.
Value least_width(const FinishedTest& test)
{
  const auto& size = test.record.size;
  double least = size[0];
  for (const double one : size)
    if (one > 0.0)
      least = std::min(least, one);
  if (!(test.record.specimen.resolution > 0.0))
    return std::nullopt;
  return size[0] > 0.0 ? test.record.specimen.resolution * least / size[0] : test.record.specimen.resolution;
}

Value ligament(const FinishedTest& test)
{
  const TestRecord& record = test.record;
  if (!record.notch || std::isnan(record.notch->ligament_length) || !(record.specimen.resolution > 0.0))
    return std::nullopt;
  const double mean_diameter = record.size[0] / record.specimen.resolution;
  return record.notch->ligament_length / mean_diameter;
}

Value radius_change(const FinishedTest& test)
{
  return test.record.specimen.n_grains > 0 ? Value(std::abs(test.record.specimen.radius_multiplier - 1.0))
                                           : std::nullopt;
}

/// Genesis draws grains to the wanted porosity and then scales their radii by m: of the volume 1 - φ are grains at the
/// end, and (1 - φ)/m^dim were wanted.
Value porosity_change(const FinishedTest& test)
{
  const SpecimenReport& specimen = test.record.specimen;
  if (specimen.n_grains == 0)
    return std::nullopt;
  const double grains = 1.0 - specimen.porosity;
  return std::abs(grains - grains / std::pow(specimen.radius_multiplier, test.record.dimension()));
}

/// Measure of the body; quantities of tests have theirs in their table.
struct BodyMeasure
{
  TrustMeasure measure;
  Value (*value)(const FinishedTest&);
};

constexpr BodyMeasure measures_of_bodies[] = {
  {{"least_width_over_mean_diameter", "least width of the specimen over mean grain diameter", display::plain(1),
    at_least(10.0)},
   least_width},
  {{"ligament_over_mean_diameter", "ligament of a notched body over mean grain diameter", display::plain(1),
    at_least(5.0)},
   ligament},
  {{"radius_change", "change of the grain radii by genesis, over those of the input", display::percent(2),
    at_most(1e-2)},
   radius_change},
  {{"porosity_change", "difference of the porosity from that of the input", display::plain(3), at_most(0.02)},
   porosity_change}};

/// Value of a quantity of a test. A test without a step has no energies, and therefore no balance of them.
Value measured(const TestQuantity& quantity, const FinishedTest& test)
{
  const bool is_balance = quantity.member == TestQuantity::Member(&TestResults::energy_imbalance_over_work);
  return is_balance && test.bookkeeping.steps == 0 ? std::nullopt : value_of(quantity, test).value;
}

/// The check of a measure; none where it applies to none of the tests. `value_in`: none of a test to which it does not apply.
template <typename ValueIn>
std::optional<TrustCheck> checked(const TrustMeasure& measure, const TestsOfRock& tests, const ValueIn& value_in)
{
  TrustCheck check{measure, 0, 0, 0.0, 0.0, ""};
  std::vector<double> all;
  for (const FinishedTest* const test : tests)
    if (const Value value = test->record.failure.empty() ? value_in(*test) : std::nullopt;
        value && std::isfinite(*value))
      {
        if (all.empty() || (measure.bound.side == BoundSide::at_most ? *value > check.worst : *value < check.worst))
          {
            check.worst = *value;
            check.worst_test = test->name;
          }
        all.push_back(*value);
        check.n_out += measure.is_out(*value);
      }
  const auto over_tests = statistics(all);
  if (!over_tests)
    return std::nullopt;
  check.n_tests = all.size();
  check.mean = over_tests->mean;
  return check;
}

} // namespace

std::string TrustMeasure::text(const double number) const
{
  return fmt::format("{:.{}f}{}", number / shown.scale, shown.decimals, unit());
}

std::string TrustMeasure::bound_text() const
{
  return fmt::format("{} {:g}{}", bound.side == BoundSide::at_most ? "at most" : "at least", bound.value / shown.scale,
                     unit());
}

std::string TrustCheck::warning() const
{
  return fmt::format("Out of bounds in {} of {} tests: {}; worst {} ({}), bound {}.", n_out, n_tests, measure.title,
                     measure.text(worst), worst_test, measure.bound_text());
}

std::vector<TrustCheck> trust_checks(const TestsOfRock& tests, const SeriesKind kind)
{
  std::vector<TrustCheck> checks;
  if (kind == SeriesKind::laboratory_curve)
    return checks;
  const auto add = [&](const TrustMeasure& measure, const auto& value_in) {
    if (auto check = checked(measure, tests, value_in))
      checks.push_back(std::move(*check));
  };
  const auto add_quantities = [&](const bool of_method) {
    for (const TestQuantity& quantity : test_quantities)
      if (quantity.bound && (quantity.of == QuantityOf::method) == of_method)
        add({quantity.name, quantity.title, quantity.shown, *quantity.bound},
            [&](const FinishedTest& test) { return measured(quantity, test); });
  };
  add_quantities(true);
  for (const auto& [measure, value] : measures_of_bodies)
    add(measure, value);
  add_quantities(false);
  return checks;
}

std::vector<TrustCheck> trust_checks(const Series& series) { return trust_checks(all_of(series), series.kind); }

std::vector<RockTests> by_rock(const std::vector<FinishedTest>& tests)
{
  std::vector<RockTests> rocks;
  for (const auto& test : tests)
    {
      auto rock = std::ranges::find(rocks, test.variant, &RockTests::variant);
      if (rock == rocks.end())
        rock = rocks.insert(rocks.end(), {test.variant, kind_of_series(test.record.body), {}});
      rock->tests.push_back(&test);
    }
  return rocks;
}

std::string as_text(const std::vector<TrustCheck>& checks)
{
  const auto n_out = std::ranges::count_if(checks, [](const TrustCheck& check) { return check.n_out > 0; });
  std::string text = fmt::format("How far to trust it: {} of {} measures out of their bounds\n", n_out, checks.size());
  for (const auto& [measure, n_tests, n_tests_out, mean, worst, worst_test] : checks)
    text += fmt::format("{} {}\n    worst {}, bound {}; {}\n", n_tests_out > 0 ? "✗" : "✓", measure.title,
                        measure.text(worst), measure.bound_text(),
                        n_tests_out > 0 ? fmt::format("{} of {} tests out, worst {}", n_tests_out, n_tests, worst_test)
                                        : fmt::format("{} test{}", n_tests, n_tests == 1 ? "" : "s"));
  return text;
}

std::string trust_as_text(const std::vector<FinishedTest>& tests)
{
  constexpr std::size_t most_in_full = 3; // of more rocks the worst of all is reported
  const auto rocks = by_rock(tests);
  std::string text;
  if (rocks.size() > most_in_full)
    {
      TestsOfRock all;
      for (const auto& rock : rocks)
        all.insert(all.end(), rock.tests.begin(), rock.tests.end());
      text += as_text(trust_checks(all, rocks.front().kind));
    }
  std::set<std::string> written; // one for all variants is written once
  for (const auto& [variant, kind, of_rock] : rocks)
    {
      if (rocks.size() <= most_in_full)
        {
          if (!variant.empty())
            text += variant + "\n";
          text += as_text(trust_checks(of_rock, kind));
        }
      for (const auto& sentence : shortcomings(of_rock, kind))
        if (rocks.size() <= most_in_full || written.insert(sentence).second)
          text += sentence + "\n";
    }
  return text;
}
} // namespace feldspar

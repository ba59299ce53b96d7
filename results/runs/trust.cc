#include "results/runs/trust.h"

#include "base/append.h"
#include "base/contains.h"
#include "base/text.h"
#include "laboratory/named_entries.h"
#include "results/runs/quantity_values.h"
#include "results/runs/remarks.h"
#include "results/statistics.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <set>
#include <utility>

namespace feldspar
{
namespace
{
constexpr std::size_t fewest_seeds = 3; // below that a standard deviation says nothing
constexpr std::string_view same_of_others = " The same holds for ";

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

TestsOfRock all_of(const Series& series)
{
  TestsOfRock tests;
  for (const auto& test : series.tests)
    tests.push_back(&test);
  return tests;
}

SeriesKind kind_of(const TestRecord& record)
{
  return record.body == TestBody::grains ? SeriesKind::specimens : SeriesKind::finite_elements;
}

std::string out_of_bounds(const TrustCheck& check)
{
  return fmt::format("Out of bounds in {} of {} tests: {}; worst {} ({}), bound {}.", check.n_out, check.n_tests,
                     check.measure.title, check.measure.text(check.worst), check.worst_test,
                     check.measure.bound_text());
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

std::vector<std::string> shortcomings(const TestsOfRock& tests, const SeriesKind kind)
{
  std::vector<std::string> sentences;
  std::map<std::string, std::pair<std::size_t, std::vector<std::string>>>
    alike; // by what is said: where, and further names
  for (const FinishedTest* const test : tests)
    for (const std::string& sentence : {shortcoming(*test), remark_on_splitting(*test)})
      if (!sentence.empty())
        {
          auto& of = alike.try_emplace(sentence.substr(test->name.size()), sentences.size(), std::vector<std::string>())
                       .first->second;
          if (of.first == sentences.size())
            sentences.push_back(sentence);
          else
            of.second.push_back(test->name);
        }
  for (const auto& [said, of] : alike)
    if (!of.second.empty())
      sentences[of.first] += fmt::format("{}{}.", same_of_others, some_of(of.second));
  for (const std::string& sentence :
       {remark_on_flaws(tests), remark_on_side_plates(tests), remark_on_load_control(tests), remark_on_rate(tests)})
    if (!sentence.empty())
      sentences.push_back(sentence);
  std::set<std::uint64_t> seeds;
  for (const FinishedTest* const test : tests)
    seeds.insert(test->record.seed);
  if (kind != SeriesKind::laboratory_curve && seeds.size() < fewest_seeds)
    {
      const std::string one = kind == SeriesKind::specimens ? "specimen" : "sample";
      sentences.push_back(fmt::format("Only {} {}{}: what belongs to the rock and what to the single {} cannot be told "
                                      "apart; take {} seeds or more.",
                                      seeds.size(), one, seeds.size() == 1 ? "" : "s", one, fewest_seeds));
    }
  return sentences;
}

std::vector<std::string> warnings(const TestsOfRock& tests, const SeriesKind kind)
{
  std::vector<std::string> sentences = shortcomings(tests, kind);
  for (const TrustCheck& check : trust_checks(tests, kind))
    if (check.n_out > 0)
      sentences.push_back(out_of_bounds(check));
  return sentences;
}

std::vector<std::string> warnings(const Series& series)
{
  std::vector<std::string> sentences = warnings(all_of(series), series.kind);
  for (const auto& problem : series.problems)
    sentences.push_back(problem + ".");
  return sentences;
}

SharedWarnings shared_warnings(const std::vector<Series>& series)
{
  SharedWarnings shared;
  TestsOfRock all;
  std::vector<const Series*> models;
  for (const Series& one : series)
    {
      shared.own.push_back(warnings(one));
      if (one.kind == SeriesKind::laboratory_curve)
        continue;
      models.push_back(&one);
      append(all, all_of(one));
    }
  if (models.size() < 2)
    return shared;
  const auto erase = [&](const Series& one, const std::string& sentence) {
    std::erase(shared.own[std::size_t(&one - series.data())], sentence);
  };
  for (const std::string& sentence : shortcomings(all_of(*models.front()), models.front()->kind))
    if (std::ranges::all_of(models, [&](const Series* const one) {
          const auto its = shortcomings(all_of(*one), one->kind);
          return contains(its, sentence);
        }))
      {
        shared.of_all.push_back(sentence);
        for (const Series* const one : models)
          erase(*one, sentence);
      }
  for (const TrustCheck& of_all : trust_checks(all, models.front()->kind))
    {
      std::vector<std::string> sentences; // of the models that are out
      for (const Series* const one : models)
        for (const TrustCheck& check : trust_checks(*one))
          if (check.measure.name == of_all.measure.name && check.n_out > 0)
            sentences.push_back(out_of_bounds(check));
      if (sentences.size() < models.size())
        continue;
      shared.of_all.push_back(out_of_bounds(of_all));
      for (std::size_t k = 0; k < models.size(); ++k)
        erase(*models[k], sentences[k]);
    }
  return shared;
}

std::vector<std::string> grouped_warnings(const std::vector<Series>& series)
{
  struct Alike
  {
    std::string form; ///< without names of tests and digits
    std::string first;
    std::size_t n; ///< models
  };
  std::vector<Alike> all_alike;
  std::vector<std::string> problems;
  TestsOfRock all;
  std::size_t n_models = 0;
  SeriesKind kind = SeriesKind::specimens;
  for (const Series& one : series)
    {
      for (const auto& problem : one.problems)
        problems.push_back(problem + ".");
      if (one.kind == SeriesKind::laboratory_curve)
        continue;
      ++n_models;
      kind = one.kind;
      append(all, all_of(one));
      std::set<std::string> forms;
      for (const std::string& sentence : shortcomings(all_of(one), one.kind))
        {
          std::string form = sentence.substr(0, sentence.find(same_of_others));
          for (const FinishedTest& test : one.tests)
            if (const std::size_t at = form.find(test.name); at != std::string::npos)
              form.erase(at, test.name.size());
          std::erase_if(form, [](const char c) { return '0' <= c && c <= '9'; });
          if (!forms.insert(form).second)
            continue;
          const auto same = std::ranges::find(all_alike, form, &Alike::form);
          if (same == all_alike.end())
            all_alike.push_back({form, sentence, 1});
          else
            ++same->n;
        }
    }
  std::vector<std::string> sentences;
  for (const auto& [form, first, n] : all_alike)
    sentences.push_back(
      n == 1 ? first : fmt::format("{} (so in {} of {} series).", first.substr(0, first.size() - 1), n, n_models));
  for (const TrustCheck& check : trust_checks(all, kind))
    if (check.n_out > 0)
      sentences.push_back(out_of_bounds(check));
  append(sentences, problems);
  return sentences;
}

std::vector<RockTests> by_rock(const std::vector<FinishedTest>& tests)
{
  std::vector<RockTests> rocks;
  for (const auto& test : tests)
    {
      auto rock = std::ranges::find(rocks, test.variant, &RockTests::variant);
      if (rock == rocks.end())
        rock = rocks.insert(rocks.end(), {test.variant, kind_of(test.record), {}});
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

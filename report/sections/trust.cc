#include "report/sections/trust.h"

#include "results/statistics.h"

#include <fmt/format.h>

#include <cmath>
#include <functional>
#include <optional>
#include <set>

namespace feldspar
{
namespace
{
constexpr double percent = 1e-2;
constexpr std::size_t fewest_seeds = 3; // below that a standard deviation says nothing

enum class Side
{
  at_most,
  at_least
};

struct Measure
{
  std::string name;
  std::string unit;
  double scale;
  int decimals;
  Side side;
  double bound;
  std::function<std::optional<double>(const FinishedTest&)> value;

  std::string text(const double number) const { return fmt::format("{:.{}f}{}", number / scale, decimals, unit); }
  std::string bound_text() const
  {
    return fmt::format("{} {:g}{}", side == Side::at_most ? "at most" : "at least", bound / scale, unit);
  }
  bool is_out(const double number) const { return side == Side::at_most ? number > bound : number < bound; }
};

const std::vector<Measure>& measures()
{
  const auto result = [](Figure TestResults::*member) {
    return [member](const FinishedTest& test) { return (test.results.*member).value; };
  };
  static const std::vector<Measure> all{
    {"energy imbalance over boundary work", " %", percent, 2, Side::at_most, 1 * percent,
     [](const FinishedTest& test) -> std::optional<double> {
       if (test.bookkeeping.steps == 0 || std::isnan(test.results.energy_imbalance_over_work))
         return std::nullopt;
       return test.results.energy_imbalance_over_work;
     }},
    {"kinetic over strain energy, largest over the rows up to the peak", " %", percent, 3, Side::at_most, 1 * percent,
     result(&TestResults::kinetic_to_strain_energy)},
    {"unbalanced over contact force, mean over the rows up to the peak", " %", percent, 3, Side::at_most, 1 * percent,
     result(&TestResults::unbalanced_force_ratio)},
    {"difference of the end stresses over the peak, largest over the rows", " %", percent, 1, Side::at_most,
     5 * percent, result(&TestResults::end_stress_difference)},
    {"P-wave transits up to the peak", "", 1.0, 0, Side::at_least, 20, result(&TestResults::p_wave_transits_to_peak)},
    {"servo error of the confinement, mean over the rows up to the peak", " %", percent, 2, Side::at_most, 1 * percent,
     result(&TestResults::servo_error)},
    {"servo error of the confinement, largest over the rows up to the peak, each a mean since the row before", " %",
     percent, 1, Side::at_most, 3 * percent, result(&TestResults::servo_error_largest)},
    {"resolution, width over mean grain diameter", "", 1.0, 1, Side::at_least, 10,
     [](const FinishedTest& test) -> std::optional<double> {
       if (!(test.record.specimen.resolution > 0.0))
         return std::nullopt;
       return test.record.specimen.resolution;
     }},
    {"radius multiplier of genesis, distance from 1", " %", percent, 2, Side::at_most, 1 * percent,
     [](const FinishedTest& test) -> std::optional<double> {
       if (test.record.specimen.n_grains == 0)
         return std::nullopt;
       return std::abs(test.record.specimen.radius_multiplier - 1.0);
     }}};
  return all;
}

std::set<std::uint64_t> seeds_of(const Series& series)
{
  std::set<std::uint64_t> seeds;
  for (const auto& test : series.tests)
    seeds.insert(test.record.seed);
  return seeds;
}
} // namespace

std::vector<TrustCheck> trust_checks(const Series& series)
{
  std::vector<TrustCheck> checks;
  if (series.kind == SeriesKind::laboratory_curve)
    return checks;
  for (const Measure& measure : measures())
    {
      TrustCheck check{measure.name, measure.bound_text(), "", "", 0, 0};
      std::vector<double> all;
      double worst = 0.0;
      for (const auto& test : series.tests)
        if (const auto value = measure.value(test))
          {
            if (all.empty() || (measure.side == Side::at_most ? *value > worst : *value < worst))
              {
                worst = *value;
                check.worst = fmt::format("{} ({})", measure.text(worst), test.name);
              }
            all.push_back(*value);
            check.n_out += measure.is_out(*value);
          }
      check.n_tests = all.size();
      if (const auto over_tests = statistics(all))
        check.mean = measure.text(over_tests->mean);
      if (check.n_tests > 0)
        checks.push_back(check);
    }
  return checks;
}

std::vector<std::string> warnings(const Series& series)
{
  std::vector<std::string> sentences;
  for (const auto& check : trust_checks(series))
    if (check.n_out > 0)
      sentences.push_back(fmt::format("Out of bounds in {} of {} tests: {}; worst {}, bound {}.", check.n_out,
                                      check.n_tests, check.measure, check.worst, check.bound));
  for (const auto& test : series.tests)
    if (!test.record.failure.empty())
      sentences.push_back(fmt::format("{} could not be {}: {}.", test.name,
                                      test.record.curve.empty() ? "made" : "finished", test.record.failure));
    else if (!test.results.peak_stress.value)
      sentences.push_back(fmt::format("{} has no strength: {}.", test.name, test.results.peak_stress.reason));
    else if (!test.record.ended_early.empty())
      sentences.push_back(fmt::format("{} ended early: {}.", test.name, test.record.ended_early));
  if (const auto n = seeds_of(series).size(); series.kind != SeriesKind::laboratory_curve && n < fewest_seeds)
    {
      const std::string one = series.kind == SeriesKind::specimens ? "specimen" : "sample";
      sentences.push_back(fmt::format("Only {} {}{}: what belongs to the rock and what to the single {} cannot be told "
                                      "apart; take {} seeds or more.",
                                      n, one, n == 1 ? "" : "s", one, fewest_seeds));
    }
  for (const auto& problem : series.problems)
    sentences.push_back(problem + ".");
  return sentences;
}

Table specimen_table(const Series& series)
{
  Table table{
    "specimens",
    series.kind == SeriesKind::specimens ? "Specimens" : "Representative volumes at the points, the first of each seed",
    {"seed", "grains", "joints", "coordination number", "in the core", "gap ratio", "porosity", "mean overlap / radius",
     "width / mean diameter", "radius multiplier", "tests", "steps", "run time of the tests [s]"},
    {}};
  for (const auto seed : seeds_of(series))
    {
      const FinishedTest* first = nullptr;
      std::size_t n = 0;
      std::uint64_t steps = 0;
      double time = 0.0;
      for (const auto& test : series.tests)
        if (test.record.seed == seed)
          {
            if (!first)
              first = &test;
            ++n;
            steps += test.bookkeeping.steps;
            time += test.bookkeeping.wall_time;
          }
      const SpecimenReport& report = first->record.specimen;
      const auto number = [](const double value, const int decimals) {
        return std::isfinite(value) ? fmt::format("{:.{}f}", value, decimals) : std::string("–");
      };
      table.rows.push_back({fmt::format("{}", seed), fmt::format("{}", report.n_grains),
                            fmt::format("{}", report.n_joints), number(report.coordination_number, 3),
                            number(report.coordination_number_core, 3), number(report.installation_gap_ratio, 4),
                            number(report.porosity, 4), number(report.mean_overlap_ratio, 5),
                            number(report.resolution, 1), number(report.radius_multiplier, 4), fmt::format("{}", n),
                            fmt::format("{}", steps), number(time, 0)});
    }
  return table;
}
} // namespace feldspar

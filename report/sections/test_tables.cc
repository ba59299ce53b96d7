#include "report/sections/tables.h"

#include "base/append.h"
#include "report/sections/text.h"
#include "results/runs/bodies.h"
#include "results/runs/test_groups.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <set>
#include <string>
#include <string_view>
#include <vector>

namespace feldspar
{
using namespace text;

namespace
{
/// Returns whether a quantity that is shown at all has a column.
bool has_column(const TestQuantity& quantity, const Findings& findings)
{
  if (quantity.column != PageColumn::where_given)
    return quantity.column == PageColumn::always;
  return std::ranges::any_of(findings.all, [&](const Series& series) {
    return std::ranges::any_of(series.tests,
                               [&](const FinishedTest& test) { return value_of(quantity, test).value.has_value(); });
  });
}
} // namespace

Table strength_table(const Findings& findings)
{
  Table table{"strengths",
              any_has_flaws(findings.all)
                ? "Strengths of every kind of test, of bodies with flaws highest nominal stresses [MPa]"
                : "Strengths of every kind of test [MPa]",
              {"test", "series", "n", "mean ± s.d.", "95 % interval of the mean"}};
  std::vector<const TestQuantity*> further{&quantity_of(&TestResults::shear_share_at_peak),
                                           &quantity_of(&TestResults::residual_deviator_ratio)};
  if (has_column(quantity_of(&TestResults::fracture_toughness), findings))
    append(further, {&quantity_of(&TestResults::fracture_toughness), &quantity_of(&TestResults::fracture_energy)});
  if (has_column(quantity_of(&TestResults::sliding_angle), findings))
    further.push_back(&quantity_of(&TestResults::sliding_angle));
  for (const TestQuantity* const quantity : further)
    table.header.push_back(with_unit(quantity->title, quantity->shown.unit));
  for (const auto& series : findings.all)
    for (const auto& group : groups_of(series))
      {
        const auto strength = statistics(values(group, &TestResults::peak_stress));
        const ShownIn shown = display::megapascals(group.kind.strength_decimals);
        table.rows.push_back({group.title() + (any_has_flaws(series.tests) ? ", body with flaws" : ""), series.label,
                              fmt::format("{}", strength ? strength->n : 0),
                              mean_and_deviation(strength, shown.scale, shown.decimals),
                              interval(strength, shown.scale, shown.decimals)});
        for (const TestQuantity* const quantity : further)
          table.rows.back().push_back(mean_and_deviation(statistics(values(group, quantity->figure())),
                                                         quantity->shown.scale, quantity->shown.decimals));
      }
  return table;
}

Table test_table(const Findings& findings)
{
  Table table{"tests",
              "Every test, SI; the file has every figure of summary.json",
              {"test", "series", "seed"},
              {},
              DataFrame{{"test", "series", "seed"}}};
  std::set<std::string_view> wanted;
  for (const TestQuantity& quantity : test_quantities)
    {
      table.file->header.emplace_back(quantity.name);
      if (!has_column(quantity, findings))
        continue;
      wanted.insert(quantity.name);
      table.header.emplace_back(quantity.name);
    }
  for (const auto& series : findings.all)
    for (const auto& test : series.tests)
      {
        const bool is_measured = series.kind == SeriesKind::laboratory_curve;
        const std::string seed = is_measured ? "" : fmt::format("{}", test.record.seed);
        auto& row = table.rows.emplace_back(std::vector{test.name, series.label, is_measured ? none : seed});
        auto& all = table.file->rows.emplace_back(std::vector{test.name, series.label, seed});
        for (const TestQuantity& quantity : test_quantities)
          {
            const Figure figure = is_measured && quantity.is_of_model() ? Figure() : value_of(quantity, test);
            all.push_back(figure.value && std::isfinite(*figure.value) ? fmt::format("{:.10g}", *figure.value) : "");
            if (wanted.contains(quantity.name))
              row.push_back(figure.value ? fmt::format("{:.4g}", *figure.value) : none);
          }
      }
  return table;
}

Table stage_table(const std::vector<FinishedTest>& tests)
{
  Table table{"stages",
              "Stages of the loading table: figures at the end of each; slope of axial stress over axial strain",
              {"stage", "confinement [MPa]", "strain [1e-3]", "stress [MPa]", "slope [GPa]", "cracks"}};
  std::set<std::uint64_t> seeds;
  for (const auto& test : tests)
    seeds.insert(test.record.seed);
  for (const auto& test : tests)
    {
      const auto results = evaluate_stages(test.record);
      for (std::size_t k = 0; k < results.size(); ++k)
        {
          const StageRecord& stage = test.record.stages[k];
          table.rows.push_back(
            {fmt::format("{}{}: {}{}", seeds.size() > 1 ? fmt::format("seed {}, ", test.record.seed) : "", k + 1,
                         stage.target, stage.reached ? "" : ", not reached"),
             number(stage.confining_pressure / mega, 1), number(1e3 * results[k].strain_at_end, 3),
             number(results[k].stress_at_end / mega, 1), number(results[k].slope, 1e9, 1),
             fmt::format("{}", results[k].n_cracks)});
        }
    }
  return table;
}

Table specimen_table(const Series& series)
{
  Table table{"specimens",
              fmt::format("{}. Tests run at the same time, so that the sum of their times exceeds that of the run",
                          series.kind == SeriesKind::specimens
                            ? "Specimens"
                            : "Representative volumes at the points, the first of each seed"),
              {"seed", "grains", "joints", "coordination number", "in the core", "gap ratio", "porosity",
               "mean overlap / radius", "width / mean diameter", "radii over those of the input", "tests made", "steps",
               "sum of the times of the tests [s]"}};
  std::map<std::uint64_t, std::vector<const FinishedTest*>> made;
  for (const auto& test : series.tests)
    if (test.record.failure.empty())
      made[test.record.seed].push_back(&test);
  const bool any_cored = std::ranges::any_of(
    made, [](const auto& of_seed) { return of_seed.second.front()->record.specimen.n_cut_joints > 0; });
  if (any_cored)
    {
      table.caption += ". Cored: packed without walls, joined, then cut free";
      append(table.header, {"joints cut", "grains removed"});
    }
  const bool any_cut = std::ranges::any_of(made, [](const auto& of_seed) {
    const auto n_grains = [](const FinishedTest* test) { return test->record.specimen.n_grains; };
    return std::ranges::any_of(
      of_seed.second, [&](const FinishedTest* test) { return n_grains(test) != n_grains(of_seed.second.front()); });
  });
  if (any_cut)
    table.caption += ". Some tests cut a body from the specimen; the figures are those of the largest body tested";
  const auto bodies = whole_bodies(series.tests);
  for (const auto& [seed, tests] : made)
    {
      std::uint64_t steps = 0;
      double time = 0.0;
      for (const auto* test : tests)
        {
          steps += test->bookkeeping.steps;
          time += test->bookkeeping.wall_time;
        }
      const SpecimenReport& report = bodies.at(seed);
      const auto number = [](const double value, const int decimals) {
        return std::isfinite(value) ? text::number(value, decimals) : std::string(none);
      };
      table.rows.push_back({fmt::format("{}", seed), fmt::format("{}", report.n_grains),
                            fmt::format("{}", report.n_joints), number(report.coordination_number, 3),
                            number(report.coordination_number_core, 3), number(report.installation_gap_ratio, 4),
                            number(report.porosity, 4), number(report.mean_overlap_ratio, 5),
                            number(report.resolution, 1), number(report.radius_multiplier, 4),
                            fmt::format("{}", tests.size()), fmt::format("{}", steps), number(time, 0)});
      if (any_cored)
        append(table.rows.back(), {fmt::format("{}", report.n_cut_joints), fmt::format("{}", report.n_removed_grains)});
    }
  return table;
}
} // namespace feldspar

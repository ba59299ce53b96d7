#include "report/sections/test_tables.h"

#include "report/sections/text.h"
#include "results/result_table.h"
#include "results/test_groups.h"

#include <fmt/format.h>

#include <set>
#include <string_view>

namespace feldspar
{
using namespace text;

Table strength_table(const Findings& findings)
{
  Table table{"strengths",
              "Strengths of every kind of test [MPa]",
              {"test", "series", "n", "mean ± s.d.", "95 % of the mean", "shear share of cracks at the peak [%]",
               "deviator at the end over peak"},
              {}};
  for (const auto& series : findings.all)
    for (const auto& group : groups_of(series))
      {
        const auto over_seeds = [&](Figure TestResults::*figure, const double unit, const int decimals) {
          const auto found = statistics(values(group, figure));
          return found ? mean_and_deviation(*found, unit, decimals) : none;
        };
        const auto strength = statistics(values(group, &TestResults::peak_stress));
        const int decimals = group.kind.strength_decimals;
        table.rows.push_back({group.title(), series.label, fmt::format("{}", strength ? strength->n : 0),
                              over_seeds(&TestResults::peak_stress, mega, decimals),
                              strength ? interval(*strength, mega, decimals) : none,
                              over_seeds(&TestResults::shear_share_at_peak, 1e-2, 1),
                              over_seeds(&TestResults::residual_deviator_ratio, 1.0, 2)});
      }
  return table;
}

/// Every figure of every test in SI; the page shows the most wanted, the file has all.
Table test_table(const Findings& findings, const bool all_figures)
{
  static const std::set<std::string_view> wanted{"peak_stress_Pa",
                                                 "strain_at_peak",
                                                 "youngs_modulus_tangent_Pa",
                                                 "youngs_modulus_initial_Pa",
                                                 "poissons_ratio_initial",
                                                 "crack_initiation_stress_Pa",
                                                 "crack_damage_stress_Pa",
                                                 "n_tension_cracks",
                                                 "n_shear_cracks",
                                                 "energy_imbalance_over_work",
                                                 "wall_time_s"};
  Table table{"tests", "Every test, SI; the file has every figure of summary.json", {"test", "series", "seed"}, {}};
  for (const auto& entry : result_table())
    if (all_figures || wanted.contains(entry.name))
      table.header.emplace_back(entry.name);
  for (const auto& series : findings.all)
    for (const auto& test : series.tests)
      {
        std::vector<std::string> row{test.name, series.label, fmt::format("{}", test.record.seed)};
        for (const auto& entry : result_table())
          if (all_figures || wanted.contains(entry.name))
            {
              const Figure figure = entry.value(test);
              row.push_back(!figure.value ? (all_figures ? "" : none)
                                          : fmt::format("{:.{}g}", *figure.value, all_figures ? 10 : 4));
            }
        table.rows.push_back(row);
      }
  return table;
}
} // namespace feldspar

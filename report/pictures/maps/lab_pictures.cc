#include "base/append.h"
#include "report/pictures/figures.h"
#include "report/pictures/plot_style.h"
#include "results/runs/test_groups.h"

#include <fmt/format.h>

#include <algorithm>
#include <string>
#include <utility>

namespace feldspar
{
namespace
{
using namespace plot;

std::string title_of(const FinishedTest& test) { return group_of(test.record).title(); }

std::string with_seed(const FinishedTest& test) { return fmt::format("{}, seed {}", title_of(test), test.record.seed); }

/// Stress over strain; of a simulated test the cracks, too.
Chart curve_of(const FinishedTest& test, const std::string& title, const bool is_measured)
{
  const TestKind& kind = test.record.kind;
  ChartSeries stress{.label = is_measured ? "" : "stress", .colour = black, .width = 2.5};
  ChartSeries tension{.label = "tension cracks",
                      .colour = tension_colour,
                      .width = 2.0,
                      .dashes = 2,
                      .to_the_right = true};
  ChartSeries shear{.label = "shear cracks", .colour = shear_colour, .width = 2.0, .dashes = 4, .to_the_right = true};
  Limits<2> limits;
  limits.include({0.0, 0.0});
  for (const CurveSample& row : test.record.curve)
    {
      const double strain = kind.sign * row.axial_strain / percent;
      stress.points.push_back({strain, kind.stress(row) / mega});
      tension.points.push_back({strain, double(row.n_tension_cracks)});
      shear.points.push_back({strain, double(row.n_shear_cracks)});
      limits.include({strain, kind.stress(row) / mega});
    }
  Chart chart{
    .look = Chart::Look::sheet,
    .title = title,
    .x = {.label = fmt::format("{} [%]", kind.channel.strain_name), .from = is_measured ? limits.low[0] : 0.0},
    .y = {.label = fmt::format("{} [MPa]", kind.channel.name), .from = is_measured ? limits.low[1] : 0.0},
    .key_columns = 3,
    .series = {std::move(stress)}};
  if (is_measured)
    return chart;
  chart.right = {.label = "broken segments", .from = 0.0};
  chart.series.push_back(std::move(tension));
  if (test.record.curve.back().n_shear_cracks > 0)
    chart.series.push_back(std::move(shear));
  return chart;
}
} // namespace

Pictures single_test_pictures(const Series& series)
{
  Pictures pictures;
  for (const auto& test : series.tests)
    {
      if (test.record.curve.empty())
        continue; // it could not be made, or its curve is missing
      const bool is_measured = series.kind == SeriesKind::laboratory_curve;
      const std::string title =
        is_measured ? fmt::format("{}: {}", series.tests.size() > 1 ? test.name : series.label, title_of(test))
                    : title_of(test);
      pictures.push_back({.name = test.name + "_stress_strain",
                          .caption = title,
                          .alternative = fmt::format("Stress against {}{}, {}.", test.record.kind.channel.strain_name,
                                                     is_measured ? "" : " and count of cracks", title),
                          .width = 900,
                          .height = 650,
                          .raster = true,
                          .panels = {curve_of(test, is_measured ? title : with_seed(test), is_measured)}});
      append(pictures, crack_map(test, title));
    }
  return pictures;
}
} // namespace feldspar

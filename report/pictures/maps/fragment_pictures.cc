#include "report/pictures/figures.h"
#include "report/pictures/maps/map.h"
#include "report/pictures/maps/specimen_data.h"
#include "report/pictures/plot_style.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <utility>

namespace feldspar
{
namespace
{
using namespace plot;

/// Disc or sphere [m^dim]; a common factor.
double volume(const GrainPicture& grain, const std::size_t axis)
{
  return std::pow(grain.radius, axis == 2 ? 3.0 : 2.0);
}

/// Equivalent diameter of each fragment: of the circle or sphere of its grains' volume [m].
std::map<std::uint32_t, double> fragment_diameters(const FinishedTest& test)
{
  const std::size_t axis = vertical_axis(test.record);
  std::map<std::uint32_t, double> diameters;
  for (const auto& grain : test.appearance.grains_at_end)
    diameters[grain.fragment] += volume(grain, axis);
  for (auto& [number, diameter] : diameters)
    diameter = 2.0 * std::pow(diameter, axis == 2 ? 1.0 / 3.0 : 0.5);
  return diameters;
}
} // namespace

Pictures fragment_map(const FinishedTest& test, const std::string& title)
{
  if (test.appearance.grains_at_end.empty())
    return {};
  const TestRecord& record = test.record;
  Picture picture{
    .name = test.name + "_fragments",
    .caption = "",
    .alternative =
      fmt::format("Map of the fragments of {} ({}): {} of two grains or more; the largest has {:.0f} % of the volume.",
                  title, seed_of(test), test.results.n_fragments.value.value_or(0.0),
                  100.0 * test.results.largest_fragment_share.value.value_or(0.0)),
    .raster = true,
    .vector = false};
  if (record.dimension() == 3)
    {
      picture.caption =
        fmt::format("{}, {}: fragments at the end, on the half behind the mid-plane, where their grains "
                    "were at the start",
                    title, seed_of(test));
      picture.width = 300;
      picture.height = 600;
      picture.body = specimen_data({{&test, fmt::format("{}, {}", title, seed_of(test))}}, ShownOnPaper::fragments);
      return {std::move(picture)};
    }
  const MapFrame map_frame = map_frame_of(test);
  const MapLimits& frame = map_frame.frame;
  const auto diameters = fragment_diameters(test);
  Limits<1> of_loose;
  for (const auto& [number, diameter] : diameters)
    if (number > 0)
      of_loose.include({diameter});
  const auto& grains = test.appearance.grains_at_end;
  ChartSeries body = grain_circles(grains, false);
  body.label = "largest piece";
  ChartSeries loose = grain_circles(grains, true);
  loose.colours = ChartSeries::Colours::by_value;
  auto circle = loose.points.begin();
  for (const auto& grain : grains)
    if (grain.fragment > 0)
      (*circle++)[3] = diameters.at(grain.fragment) / milli;
  Chart chart = empty_map(frame, record);
  chart.series = {std::move(body), std::move(loose)};
  // viridis, whose brightness grows all the way
  chart.palette = {"#440154", "#3b528b", "#21918c", "#5ec962", "#fde725"};
  chart.colour = {.label = "equivalent diameter [mm]",
                  .logarithmic = true,
                  .ticks = {0.5, 1.0, 1.5, 2.0, 3.0, 5.0, 10.0, 20.0, 50.0, 100.0, 200.0}};
  if (of_loose.high[0] > 0.0)
    {
      chart.colour.from = 0.95 * of_loose.low[0] / milli;
      chart.colour.to = 1.05 * of_loose.high[0] / milli;
    }
  const auto [width, height] = panel_size(frame);
  picture.caption =
    fmt::format("{}, {}: fragments at the end, coloured by their size{}", title, seed_of(test), map_frame.remark());
  picture.width = width + 90;
  picture.height = height;
  picture.panels = {std::move(chart)};
  return {std::move(picture)};
}

Pictures fragment_size_picture(const SeriesAmong& of)
{
  const Series& series = of.series();
  Chart chart{.x = {.label = "equivalent diameter [mm]",
                    .logarithmic = true,
                    .ticks = {1.0, 2.0, 5.0, 10.0, 20.0, 50.0, 100.0, 200.0, 500.0}},
              .y = {.label = "volume in smaller fragments [%]", .from = 0.0, .to = 100.0},
              .key_columns = 2};
  for (const auto& group : shown(groups_of(series)))
    {
      // All fragments of the group's tests, by size, with their volumes.
      std::vector<std::pair<double, double>> fragments;
      double all = 0.0;
      for (const auto* test : group.tests)
        for (const auto& [number, diameter] : fragment_diameters(*test))
          {
            const double of_fragment = std::pow(diameter, vertical_axis(test->record) == 2 ? 3.0 : 2.0);
            fragments.emplace_back(diameter, of_fragment);
            all += of_fragment;
          }
      if (fragments.empty())
        continue;
      std::ranges::sort(fragments);
      const std::size_t n = chart.series.size();
      ChartSeries line{.label = group.title(),
                       .colour = colour(series, of.n),
                       .width = n < 5 ? 2.2 : 1.2,
                       .dashes = 1 + int(n % 5)};
      double sum = 0.0;
      for (const auto& [diameter, of_fragment] : fragments)
        {
          line.points.push_back({diameter / milli, sum / all / percent});
          sum += of_fragment;
          line.points.push_back({diameter / milli, sum / all / percent});
        }
      chart.series.push_back(std::move(line));
    }
  if (chart.empty())
    return {};
  return {{.name = "fragment_sizes_" + file_name(series.label),
           .caption = "Sizes of the fragments at the end: share of the volume in fragments up to a size",
           .alternative = "Share of the volume in fragments up to a size, for each kind of test.",
           .width = 640,
           .height = 460,
           .panels = {std::move(chart)}}};
}
} // namespace feldspar

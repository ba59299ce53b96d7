#include "base/append.h"
#include "base/prefixes.h"
#include "report/pictures/figures.h"
#include "report/pictures/maps/group_colour.h"
#include "report/pictures/maps/map.h"
#include "report/pictures/maps/near_grains.h"
#include "report/pictures/maps/specimen_data.h"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

namespace feldspar
{
namespace
{
/// Cracks where they came to: moved as the two grains that they part moved on the mean.
std::vector<Crack> carried(const FinishedTest& test)
{
  std::vector<Crack> cracks = test.record.cracks;
  const NearGrains grains(test.appearance.grains_at_end);
  for (Crack& crack : cracks)
    for (const GrainPicture* grain : grains.parted_by(crack))
      for (std::size_t c = 0; c < 3 && grain != nullptr; ++c)
        crack.centroid[c] += 0.5 * (grain->position[c] - grain->start[c]);
  return cracks;
}

/// The order in which the first joints broke, on a map of that stage; those that broke later in grey.
void add_numbers(Chart& chart, const std::vector<Crack>& cracks, const MapStage& stage, const MapPaper& paper)
{
  const auto first = number_first_cracks(cracks, paper);
  ChartSeries later{.kind = ChartSeries::Kind::segments, .colour = "#707070", .width = 1.8};
  for (const auto& crack : cracks)
    if (crack.step > stage.last_step &&
        std::ranges::any_of(first, [&](const auto& one) { return one.joint == crack.joint; }))
      later.points.push_back(trace_of(crack));
  ChartSeries numbers{.kind = ChartSeries::Kind::texts, .colour = "#101010", .size = 14.0};
  for (const auto& one : first)
    {
      numbers.points.push_back({one.place[0] / milli, one.place[1] / milli});
      numbers.texts.push_back(fmt::format("{}", one.number));
    }
  append(chart.series, {later, numbers});
}
} // namespace

Pictures crack_map(const FinishedTest& test, const std::string& title)
{
  if (test.record.body == TestBody::finite_elements)
    return damage_map(test, title);
  const TestRecord& record = test.record;
  const auto& grains = test.appearance.grains_at_end;
  if (grains.empty() || record.curve.empty())
    return {};
  const auto all_stages = map_stages(record);
  Picture picture{.name = test.name + "_cracks",
                  .caption = fmt::format("{}, {}: cracks {}", title, seed_of(test), in_words(all_stages)),
                  .alternative =
                    fmt::format("Maps of the cracks of {} ({}): {} tension and {} shear cracks at the end.", title,
                                seed_of(test), test.results.n_tension_cracks, test.results.n_shear_cracks),
                  .raster = true,
                  .vector = false};
  if (record.dimension() == 3)
    {
      picture.caption += ", on the half behind the mid-plane";
      picture.width = 300 * int(all_stages.size());
      picture.height = 600;
      picture.body = specimen_data({{&test, fmt::format("{}, {}", title, seed_of(test))}});
      return {std::move(picture)};
    }
  const MapFrame map_frame = map_frame_of(test);
  const MapLimits& frame = map_frame.frame;
  const auto colours = group_colours(grains);
  for (const MapStage& stage : all_stages)
    {
      const bool at_end = &stage == &all_stages.back();
      Chart chart = empty_map(frame, record, stage.title);
      ChartSeries circles{.kind = ChartSeries::Kind::circles, .colours = ChartSeries::Colours::own};
      for (std::size_t i = 0; i < grains.size(); ++i)
        {
          const auto& centre = at_end ? grains[i].position : grains[i].start;
          circles.points.push_back(
            {centre[0] / milli, centre[1] / milli, grains[i].radius / milli, double(colours[i])});
        }
      chart.series.push_back(std::move(circles));
      append(chart.series, flaw_lines(test));
      const std::vector<Crack> cracks = at_end ? carried(test) : record.cracks;
      std::vector<Crack> broken = cracks;
      std::erase_if(broken, [&](const Crack& crack) { return crack.step > stage.last_step; });
      append(chart.series, crack_traces(broken, 1.8));
      if (picture.panels.empty())
        add_numbers(chart, cracks, stage, paper_of(frame));
      picture.panels.push_back(std::move(chart));
    }
  const auto [width, height] = panel_size(frame);
  const int n_panels = int(picture.panels.size());
  picture.columns = is_long(frame) ? 1 : n_panels;
  picture.caption +=
    (record.cracks.empty() ? "" : "; numbers: the order in which the first joints broke") + map_frame.remark();
  picture.width = width * picture.columns;
  picture.height = height * (n_panels / picture.columns);
  return {std::move(picture)};
}
} // namespace feldspar

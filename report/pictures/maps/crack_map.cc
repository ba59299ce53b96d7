#include "base/append.h"
#include "base/prefixes.h"
#include "report/pictures/figures.h"
#include "report/pictures/maps/group_colour.h"
#include "report/pictures/maps/map.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <iterator>
#include <limits>
#include <map>
#include <utility>

namespace feldspar
{
namespace
{
/// Cracks where they came to: moved as the two grains whose surfaces were the nearest moved on the mean.
std::vector<Crack> carried(const FinishedTest& test)
{
  std::vector<Crack> cracks = test.record.cracks;
  std::map<std::uint64_t, std::array<double, 3>> of_joints;
  for (Crack& crack : cracks)
    {
      auto found = of_joints.find(crack.joint);
      if (found == of_joints.end())
        {
          std::array<std::pair<double, const GrainPicture*>, 2> nearest{
            std::pair{std::numeric_limits<double>::infinity(), nullptr},
            std::pair{std::numeric_limits<double>::infinity(), nullptr}};
          for (const auto& grain : test.appearance.grains_at_end)
            {
              const double distance = std::hypot(grain.start[0] - crack.centroid[0], grain.start[1] - crack.centroid[1],
                                                 grain.start[2] - crack.centroid[2]) -
                                      grain.radius;
              if (distance < nearest[0].first)
                {
                  nearest[1] = nearest[0];
                  nearest[0] = {distance, &grain};
                }
              else if (distance < nearest[1].first)
                nearest[1] = {distance, &grain};
            }
          std::array<double, 3> moved{};
          for (const auto& [distance, grain] : nearest)
            for (std::size_t c = 0; c < 3 && grain != nullptr; ++c)
              moved[c] += 0.5 * (grain->position[c] - grain->start[c]);
          found = of_joints.emplace(crack.joint, moved).first;
        }
      for (std::size_t c = 0; c < 3; ++c)
        crack.centroid[c] += found->second[c];
    }
  return cracks;
}

/// The order in which the first joints broke, on a map of that stage; those that broke later in grey.
void add_numbers(Chart& chart, const std::vector<Crack>& cracks, const std::size_t axis, const MapStage& stage,
                 const MapPaper& paper)
{
  const auto first = number_first_cracks(cracks, axis, paper);
  ChartSeries later{.kind = ChartSeries::Kind::segments, .colour = "#707070", .width = 1.8};
  for (const auto& crack : cracks)
    if (crack.step > stage.last_step &&
        std::any_of(first.begin(), first.end(), [&](const auto& one) { return one.joint == crack.joint; }))
      later.points.push_back(trace_of(crack, axis));
  ChartSeries numbers{.kind = ChartSeries::Kind::texts, .colour = "#101010", .size = 14.0};
  for (const auto& one : first)
    {
      numbers.points.push_back({one.place[0] / milli, one.place[1] / milli});
      numbers.texts.push_back(fmt::format("{}", one.number));
    }
  append(chart.series, {later, numbers});
}
} // namespace

Pictures crack_map(const FinishedTest& whole, const std::string& title)
{
  if (whole.record.body == TestBody::finite_elements)
    return damage_map(whole, title);
  const FinishedTest test = cut_open(whole);
  const TestRecord& record = test.record;
  const auto& grains = test.appearance.grains_at_end;
  if (grains.empty() || record.curve.empty())
    return {};
  const std::size_t axis = vertical_axis(record);
  const auto all_stages = map_stages(record);
  const MapFrame map_frame = map_frame_of(test);
  const MapLimits& frame = map_frame.frame;
  const auto colours = group_colours(grains);
  std::vector<Chart> panels;
  for (const MapStage& stage : all_stages)
    {
      const bool at_end = &stage == &all_stages.back();
      Chart chart = empty_map(frame, record, stage.title);
      ChartSeries circles{.kind = ChartSeries::Kind::circles, .colours = ChartSeries::Colours::own};
      for (std::size_t i = 0; i < grains.size(); ++i)
        {
          const auto& centre = at_end ? grains[i].position : grains[i].start;
          circles.points.push_back(
            {centre[0] / milli, centre[axis] / milli, grains[i].radius / milli, double(colours[i])});
        }
      chart.series.push_back(std::move(circles));
      append(chart.series, flaw_lines(test));
      const std::vector<Crack> cracks = at_end ? carried(test) : record.cracks;
      std::vector<Crack> broken;
      std::copy_if(cracks.begin(), cracks.end(), std::back_inserter(broken),
                   [&](const Crack& crack) { return crack.step <= stage.last_step; });
      append(chart.series, crack_traces(broken, axis, 1.8));
      if (panels.empty())
        add_numbers(chart, cracks, axis, stage, paper_of(frame));
      panels.push_back(std::move(chart));
    }
  const auto [width, height] = panel_size(frame);
  const int n_panels = int(panels.size());
  const int columns = is_long(frame) ? 1 : n_panels;
  const std::string view =
    record.dimension() == 3 ? ", in the half behind the mid-plane, with the cracks near the cut" : "";
  return {{.name = test.name + "_cracks",
           .caption = fmt::format("{}, {}: cracks {}{}{}{}", title, seed_of(test), in_words(all_stages), view,
                                  record.cracks.empty() ? "" : "; numbers: the order in which the first joints broke",
                                  map_frame.remark()),
           .alternative = fmt::format("Maps of the cracks of {} ({}): {} tension and {} shear cracks at the end.",
                                      title, seed_of(test), test.results.n_tension_cracks, test.results.n_shear_cracks),
           .width = width * columns,
           .height = height * (n_panels / columns),
           .raster = true,
           .vector = false,
           .panels = std::move(panels),
           .columns = columns}};
}
} // namespace feldspar

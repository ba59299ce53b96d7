#include "report/pictures/figures.h"
#include "report/pictures/maps/map.h"
#include "report/pictures/plot_style.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <utility>

namespace feldspar
{
namespace
{
using namespace plot;

/// Broken segments at one point of a sample.
struct PointDamage
{
  std::array<double, 2> place{};
  double depth = 0.0; ///< in front of the picture's plane
  std::size_t n_tension = 0;
  std::size_t n_shear = 0;

  std::size_t n() const { return n_tension + n_shear; }
};

/// Damage of each point, by its number.
std::map<std::uint64_t, PointDamage> damage(const TestRecord& record, const std::uint64_t last_step)
{
  std::map<std::uint64_t, PointDamage> points;
  for (const auto& crack : record.cracks)
    if (crack.step <= last_step)
      {
        PointDamage& point = points[crack.joint];
        point.place = {crack.centroid[0], crack.centroid[vertical_axis(record)]};
        point.depth = record.dimension() == 2 ? 0.0 : crack.centroid[1];
        ++(crack.kind == CrackKind::tension ? point.n_tension : point.n_shear);
      }
  return points;
}

/// The largest radius at which the circles at the points stay apart [m].
double room_for_circles(const std::map<std::uint64_t, PointDamage>& points, const TestRecord& record)
{
  double least = 0.25 * record.size[0];
  for (const auto& [first, a] : points)
    for (const auto& [second, b] : points)
      if (first < second)
        least = std::min(least, std::hypot(a.place[0] - b.place[0], a.place[1] - b.place[1], a.depth - b.depth));
  return 0.48 * least;
}
} // namespace

// Circles at the points: area by the number of broken segments, the inner one of those broken in shear.
Pictures damage_map(const FinishedTest& test, const std::string& title)
{
  const TestRecord& record = test.record;
  if (record.cracks.empty() || record.curve.empty())
    return {};
  const auto all_stages = map_stages(record);
  const auto at_end = damage(record, all_stages.back().last_step);
  std::size_t most = 0;
  for (const auto& [number, point] : at_end)
    most = std::max(most, point.n());
  const double largest_radius = room_for_circles(at_end, record);
  const auto radius = [&](const std::size_t n) { return largest_radius * std::sqrt(double(n) / double(most)); };

  MapLimits frame;
  const double height = record.size[vertical_axis(record)];
  frame.low = {-0.12 * record.size[0], -0.02 * height};
  frame.high = {1.12 * record.size[0], 1.02 * height};
  const double x = record.size[0] / milli;
  const double y = height / milli;
  const ChartSeries body{.kind = ChartSeries::Kind::area,
                         .colour = light_grey,
                         .points = {{0.0, 0.0}, {x, 0.0}, {x, y}, {0.0, y}, gap}};
  std::vector<Chart> panels;
  for (const MapStage& stage : all_stages)
    {
      ChartSeries whole{.kind = ChartSeries::Kind::circles, .colour = tension_colour};
      ChartSeries inner{.kind = ChartSeries::Kind::circles, .colour = shear_colour};
      std::size_t n_tension = 0;
      std::size_t n_shear = 0;
      for (const auto& [number, point] : damage(record, stage.last_step))
        {
          whole.points.push_back({point.place[0] / milli, point.place[1] / milli, radius(point.n()) / milli});
          inner.points.push_back({point.place[0] / milli, point.place[1] / milli, radius(point.n_shear) / milli});
          n_tension += point.n_tension;
          n_shear += point.n_shear;
        }
      whole.label = fmt::format("tension: {}", n_tension);
      inner.label = fmt::format("shear: {}", n_shear);
      panels.push_back(empty_map(frame, record, stage.title));
      panels.back().series = {body, std::move(whole), std::move(inner)};
    }
  const auto [panel_width, panel_height] = panel_size(frame);
  return {
    {.name = test.name + "_cracks",
     .caption = fmt::format(
       "{}, {}: broken segments of the representative volume at each point, {}; the area of a circle is their number, up "
       "to {}",
       title, seed_of(test), in_words(all_stages), most),
     .alternative = fmt::format("Maps of the broken segments at the points of {} ({}): {} in tension and {} in "
                                "shear at the end.",
                                title, seed_of(test), test.results.n_tension_cracks, test.results.n_shear_cracks),
     .width = panel_width * int(all_stages.size()),
     .height = panel_height,
     .raster = true,
     .vector = false,
     .panels = std::move(panels),
     .columns = int(all_stages.size())}};
}
} // namespace feldspar

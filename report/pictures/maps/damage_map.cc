#include "report/pictures/maps/damage_map.h"

#include "report/pictures/maps/map_frame.h"
#include "report/pictures/plot_style.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <iterator>
#include <map>

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

/// By the number of the point.
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
std::vector<Picture> damage_map(const FinishedTest& test, const std::string& title)
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
  std::string data;
  std::string plots;
  for (std::size_t s = 0; s < all_stages.size(); ++s)
    {
      std::string rows;
      std::size_t n_tension = 0;
      std::size_t n_shear = 0;
      for (const auto& [number, point] : damage(record, all_stages[s].last_step))
        {
          fmt::format_to(std::back_inserter(rows), "{:.6g} {:.6g} {:.6g} {:.6g}\n", point.place[0] / milli,
                         point.place[1] / milli, radius(point.n()) / milli, radius(point.n_shear) / milli);
          n_tension += point.n_tension;
          n_shear += point.n_shear;
        }
      plots += fmt::format("set title {} noenhanced\n", gnuplot_text(all_stages[s].title));
      if (rows.empty())
        {
          plots += "plot NaN notitle\n";
          continue;
        }
      data += fmt::format("$points{} << EOD\n{}EOD\n", s, rows);
      plots += fmt::format("plot $points{0} using 1:2:3 with circles fill solid noborder lc rgb '{1}' title "
                           "'tension: {2}', $points{0} using 1:2:4 with circles fill solid noborder lc rgb '{3}' title "
                           "'shear: {4}'\n",
                           s, tension_colour, n_tension, shear_colour, n_shear);
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
     .script = data + map_set_up(frame, record) +
               fmt::format("set object 1 rectangle from 0,0 to {:.6g},{:.6g} fc rgb '{}' fs solid noborder behind\n"
                           "set multiplot layout 1,{}\n{}unset multiplot\n",
                           record.size[0] / milli, height / milli, light_grey, all_stages.size(), plots)}};
}
} // namespace feldspar

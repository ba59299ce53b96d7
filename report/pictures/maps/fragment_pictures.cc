#include "report/pictures/maps/fragment_pictures.h"

#include "report/pictures/maps/map_frame.h"
#include "report/pictures/plot_style.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <limits>
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

std::vector<Picture> fragment_map(const FinishedTest& test, const std::string& title)
{
  const TestRecord& record = test.record;
  if (test.appearance.grains_at_end.empty())
    return {};
  const std::size_t axis = vertical_axis(record);
  const MapFrame map_frame = map_frame_of(test);
  const MapLimits& frame = map_frame.frame;
  const auto diameters = fragment_diameters(test);
  double smallest = std::numeric_limits<double>::infinity();
  double largest = 0.0;
  for (const auto& [number, diameter] : diameters)
    if (number > 0)
      {
        smallest = std::min(smallest, diameter);
        largest = std::max(largest, diameter);
      }
  const bool is_broken = largest > 0.0;
  std::string body;
  std::string loose;
  for (const auto& grain : test.appearance.grains_at_end)
    fmt::format_to(std::back_inserter(grain.fragment > 0 ? loose : body), "{:.6g} {:.6g} {:.6g} {:.4g}\n",
                   grain.position[0] / milli, grain.position[axis] / milli, grain.radius / milli,
                   diameters.at(grain.fragment) / milli);
  const auto [width, height] = panel_size(frame);
  return {
    {.name = test.name + "_fragments",
     .caption =
       fmt::format("{}, {}: fragments at the end, coloured by their size{}", title, seed_of(test), map_frame.remark()),
     .alternative =
       fmt::format("Map of the fragments of {} ({}): {} of two grains or more; the largest has {:.0f} % of the volume.",
                   title, seed_of(test), test.results.n_fragments.value.value_or(0.0),
                   100.0 * test.results.largest_fragment_share.value.value_or(0.0)),
     .width = width + 90,
     .height = height,
     .raster = true,
     .vector = false,
     .script =
       fmt::format("$body << EOD\n{}EOD\n$loose << EOD\n{}EOD\n", body, loose) + map_set_up(frame, record) +
       // viridis, whose brightness grows all the way
       "set palette defined (0 '#440154', 1 '#3b528b', 2 '#21918c', 3 '#5ec962', 4 '#fde725')\n"
       "set logscale cb\nset cbtics (0.5,1,1.5,2,3,5,10,20,50,100,200)\nset cblabel 'equivalent diameter [mm]'\n" +
       (is_broken ? fmt::format("set cbrange [{:.4g}:{:.4g}]\n", 0.95 * smallest / milli, 1.05 * largest / milli)
                  : std::string()) +
       fmt::format("plot $body using 1:2:3 with circles fill solid noborder lc rgb '{}' title 'largest piece'{}\n",
                   light_grey,
                   is_broken ? ", $loose using 1:2:3:4 with circles fill solid noborder lc palette notitle" : "")}};
}

std::vector<Picture> fragment_size_picture(const Series& series, const std::size_t which)
{
  std::string data;
  std::string plots;
  std::size_t n = 0;
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
      std::sort(fragments.begin(), fragments.end());
      std::string rows;
      double sum = 0.0;
      for (const auto& [diameter, of_fragment] : fragments)
        {
          fmt::format_to(std::back_inserter(rows), "{:.5g} {:.5g}\n", diameter / milli, sum / all / percent);
          sum += of_fragment;
          fmt::format_to(std::back_inserter(rows), "{:.5g} {:.5g}\n", diameter / milli, sum / all / percent);
        }
      data += fmt::format("$sizes{} << EOD\n{}EOD\n", n, rows);
      plots += fmt::format("{}$sizes{} using 1:2 with lines lw {} dt {} lc rgb '{}' {}", n ? ", " : "", n,
                           n < 5 ? 2.2 : 1.2, 1 + n % 5, colour(series, which), title(group.title()));
      ++n;
    }
  if (n == 0)
    return {};
  return {
    {.name = "fragment_sizes_" + file_name(series.label),
     .caption = "Sizes of the fragments at the end: share of the volume in fragments up to a size",
     .alternative = "Share of the volume in fragments up to a size, for each kind of test.",
     .width = 640,
     .height = 460,
     .script = data + frame("equivalent diameter [mm]", "volume in smaller fragments [%]") +
               "set logscale x\nset xtics (1,2,5,10,20,50,100,200,500)\nset yrange [0:100]\nset key maxcols 2\nplot " +
               plots + "\n"}};
}
} // namespace feldspar

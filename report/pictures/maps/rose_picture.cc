#include "report/pictures/figures.h"
#include "report/pictures/maps/map.h"
#include "report/pictures/plot_style.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <utility>

namespace feldspar
{
using namespace plot;

Pictures rose_picture(const SeriesAmong& of)
{
  constexpr double pi = std::numbers::pi;
  constexpr std::size_t n_bins = 18; // over half a turn: 10° each
  const Series& series = of.series();
  std::vector<Chart> panels;
  for (const auto& group : shown(groups_of(series)))
    {
      std::array<std::array<double, n_bins>, 2> length{}; // tension, shear
      double all = 0.0;
      for (const auto* test : group.tests)
        {
          const std::size_t axis = vertical_axis(test->record);
          for (const auto& crack : test->record.cracks)
            {
              // Angle of the normal in the plane of the picture from the axis of the test, within half a turn.
              double angle = std::atan2(crack.normal[0], crack.normal[axis]);
              angle -= pi * std::floor(angle / pi);
              const auto bin = std::min(std::size_t(angle / pi * n_bins), n_bins - 1);
              const double weight = axis == 2 ? crack.size * crack.size : crack.size;
              length[crack.kind == CrackKind::shear][bin] += weight;
              all += weight;
            }
        }
      if (!(all > 0.0))
        continue;
      double largest = 0.0;
      for (std::size_t b = 0; b < n_bins; ++b)
        largest = std::max(largest, (length[0][b] + length[1][b]) / all);
      const auto arc = [&](ChartSeries& line, const double radius, const double begin, const double end, const int n) {
        for (int k = 0; k <= n; ++k)
          {
            const double angle = begin + (end - begin) * k / n;
            line.points.push_back({radius / percent * std::sin(angle), radius / percent * std::cos(angle)});
          }
      };
      // Tension stands outside shear.
      const auto wedges = [&](const bool with_tension, ChartSeries line) {
        line.kind = ChartSeries::Kind::area;
        for (std::size_t b = 0; b < 2 * n_bins; ++b)
          {
            line.points.push_back({0.0, 0.0});
            arc(line, ((with_tension ? length[0][b % n_bins] : 0.0) + length[1][b % n_bins]) / all,
                double(b) * pi / n_bins, (double(b) + 1.0) * pi / n_bins, 6);
            line.points.push_back(gap);
          }
        return line;
      };
      const double reach = 1.12 * largest / percent;
      const double radius = std::max(1.0, std::floor(0.6 * largest / percent));
      const ChartAxis axis{.from = -reach, .to = reach, .bare = true};
      ChartSeries ring{.colour = "#909090", .width = 1.0};
      arc(ring, radius * percent, 0.0, 2.0 * pi, 90);
      panels.push_back({.look = Chart::Look::map,
                        .title = group.title(),
                        .x = axis,
                        .y = axis,
                        .equal_scales = true,
                        .key_columns = 2,
                        .series = {wedges(true, {.label = "tension", .colour = tension_colour, .opacity = 0.8}),
                                   wedges(false, {.label = "shear", .colour = shear_colour, .opacity = 0.9}),
                                   ring,
                                   {.kind = ChartSeries::Kind::texts,
                                    .colour = "#404040",
                                    .size = 12.0,
                                    .points = {{0.72 * reach, -0.94 * reach}},
                                    .texts = {fmt::format("ring: {} %", radius)}}}});
    }
  if (panels.empty())
    return {};
  const int columns = std::min(int(panels.size()), 2);
  const int lines = (int(panels.size()) + 1) / 2;
  return {{.name = "rose_" + file_name(series.label),
           .caption =
             "Directions of the crack normals, weighted by length (all tests of a kind, to their end). Up is the "
             "axis of the test: a crack along the axis counts to the sides",
           .alternative = "Rose diagrams of the crack normals of " + series.label + ".",
           .width = 360 * columns,
           .height = 400 * lines,
           .panels = std::move(panels),
           .columns = columns}};
}
} // namespace feldspar

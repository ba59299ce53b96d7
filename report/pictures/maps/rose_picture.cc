#include "report/pictures/maps/rose_picture.h"

#include "report/pictures/maps/map_frame.h"
#include "report/pictures/plot_style.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <iterator>
#include <numbers>

namespace feldspar
{
using namespace plot;

std::vector<Picture> rose_picture(const Series& series)
{
  constexpr double pi = std::numbers::pi;
  constexpr std::size_t n_bins = 18; // over half a turn: 10° each
  std::string data;
  std::string plots;
  int n_panels = 0;
  for (const auto& group : shown(groups_of(series)))
    {
      std::array<std::array<double, n_bins>, 2> length{}; // tension, shear
      double all = 0.0;
      for (const auto* test : group.tests)
        {
          const std::size_t axis = vertical_axis(test->record);
          for (const auto& crack : test->record.cracks)
            {
              // Of the normal in the plane of the picture from the axis of the test, within half a turn.
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
      const auto wedges = [&](const bool with_tension) {
        std::string rows;
        for (std::size_t b = 0; b < 2 * n_bins; ++b)
          {
            const double radius = (with_tension ? length[0][b % n_bins] : 0.0) / all + length[1][b % n_bins] / all;
            rows += "0 0\n";
            for (int k = 0; k <= 6; ++k)
              {
                const double angle = (double(b) + k / 6.0) * pi / n_bins;
                fmt::format_to(std::back_inserter(rows), "{:.5g} {:.5g}\n", radius / percent * std::sin(angle),
                               radius / percent * std::cos(angle));
              }
            rows += "0 0\n\n";
          }
        return rows;
      };
      data += fmt::format("$all{0} << EOD\n{1}EOD\n$shear{0} << EOD\n{2}EOD\n", n_panels, wedges(true), wedges(false));
      const double reach = 1.12 * largest / percent;
      const double ring = std::max(1.0, std::floor(0.6 * largest / percent));
      plots += fmt::format(
        "unset label\nset title {0} noenhanced\nset xrange [-{1}:{1}]; set yrange [-{1}:{1}]\n"
        "set object 1 circle at 0,0 size {2} fs empty border lc rgb '#909090' lw 0.7 front\n"
        "set label 1 'ring: {2} %' at graph 0.98,0.03 right tc rgb '#404040' front\n"
        "plot $all{3} using 1:2 with filledcurves closed fs solid 0.8 noborder lc rgb '{4}' title 'tension', "
        "$shear{3} using 1:2 with filledcurves closed fs solid 0.9 noborder lc rgb '{5}' title 'shear'\n",
        gnuplot_text(group.title()), reach, ring, n_panels, tension_colour, shear_colour);
      ++n_panels;
    }
  if (n_panels == 0)
    return {};
  const int columns = std::min(n_panels, 2);
  const int lines = (n_panels + 1) / 2;
  return {{.name = "rose_" + file_name(series.label),
           .caption =
             "Directions of the crack normals, weighted by length (all tests of a kind, to their end). Up is the "
             "axis of the test: a crack along the axis counts to the sides",
           .alternative = "Rose diagrams of the crack normals of " + series.label + ".",
           .width = 360 * columns,
           .height = 400 * lines,
           .script = data + fmt::format("set multiplot layout {},{}\nset size square\nunset border; unset tics\n"
                                        "set key below center horizontal samplen 1.5\n{}unset multiplot\n",
                                        lines, columns, plots)}};
}
} // namespace feldspar

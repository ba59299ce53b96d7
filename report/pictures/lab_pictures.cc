#include "report/pictures/lab_pictures.h"

#include "base/quoted.h"
#include "report/pictures/maps/crack_map.h"
#include "report/pictures/maps/map_marks.h"
#include "report/pictures/plane_view.h"
#include "report/pictures/plot_style.h"
#include "results/runs/test_groups.h"

#include <fmt/format.h>

#include <algorithm>
#include <iterator>
#include <string>

namespace feldspar
{
namespace
{
using namespace plot;

std::string title_of(const FinishedTest& test) { return group_of(test.record).title(); }

/// A name for the data of a test.
std::string block(const char* what, const FinishedTest& test) { return data_block(what, test.name); }

std::string curve_data(const FinishedTest& test)
{
  const double sign = test.record.kind.sign;
  std::string text = fmt::format("{} << EOD\n", block("curve", test));
  for (const auto& row : test.record.curve)
    fmt::format_to(std::back_inserter(text), "{} {} {} {}\n", sign * row.axial_strain * 100.0,
                   test.record.kind.stress(row) / mega, row.n_tension_cracks, row.n_shear_cracks);
  return text + "EOD\n";
}

/// Grains of the largest fragment and the others; cracks as the faces that broke.
std::string map_data(const FinishedTest& test)
{
  std::string text;
  for (const bool loose : {false, true})
    {
      text += fmt::format("{} << EOD\n", block(loose ? "loose" : "grains", test));
      for (const auto& grain : test.appearance.grains_at_end)
        if ((grain.fragment > 0) == loose)
          fmt::format_to(std::back_inserter(text), "{} {} {}\n", grain.position[0] / milli, grain.position[1] / milli,
                         grain.radius / milli);
      text += "EOD\n";
    }
  for (const CrackKind kind : {CrackKind::tension, CrackKind::shear})
    {
      text += fmt::format("{} << EOD\n", block(kind == CrackKind::tension ? "tension" : "shear", test));
      for (const auto& crack : test.record.cracks)
        if (crack.kind == kind)
          text += trace_of(crack, 1);
      text += "EOD\n";
    }
  return text + flaw_outlines(test, test.name).data;
}

/// The curve of a measurement: stress alone.
std::string measured_plot(const FinishedTest& test, const std::string& title)
{
  return fmt::format("set title {} noenhanced\n"
                     "set xlabel '{} [%]'\n"
                     "set ylabel '{} [MPa]'\n"
                     "set xtics nomirror; set ytics nomirror; set border 3\n"
                     "set xrange [*<0:*]; set yrange [*<0:*]\n"
                     "unset key\n"
                     "plot {} using 1:2 with lines lw 2.5 lc rgb '{}'\n",
                     gnuplot_text(title), test.record.kind.channel.strain_name, test.record.kind.channel.name,
                     block("curve", test), black);
}

std::string curve_plot(const FinishedTest& test)
{
  const auto& last = test.record.curve.back();
  std::string text = fmt::format("set title {} noenhanced\n"
                                 "set size noratio\n"
                                 "set xlabel '{} [%]'\n"
                                 "set ylabel '{} [MPa]'\n"
                                 "set y2label 'broken segments'\n"
                                 "set xtics nomirror autofreq; set ytics nomirror autofreq; set y2tics autofreq\n"
                                 "set xrange [0:*]; set yrange [0:*]; set y2range [0:*]\n"
                                 "set border 11; set lmargin 10; set rmargin 14\n"
                                 "set bmargin 6\n"
                                 "set key outside bottom center horizontal Left reverse samplen 2 width 1\n",
                                 gnuplot_text(fmt::format("{}, seed {}", title_of(test), test.record.seed)),
                                 test.record.kind.channel.strain_name, test.record.kind.channel.name);
  const std::string data = block("curve", test);
  text += fmt::format("plot {0} using 1:2 with lines lw 2.5 lc rgb 'black' title 'stress', "
                      "{0} using 1:3 axes x1y2 with lines lw 2 dt 2 lc rgb '{1}' title 'tension cracks'",
                      data, tension_colour);
  if (last.n_shear_cracks > 0)
    text +=
      fmt::format(", {} using 1:4 axes x1y2 with lines lw 2 dt 4 lc rgb '{}' title 'shear cracks'", data, shear_colour);
  return text + "\nunset y2tics; unset y2label\n";
}

/// upwards: the name of the axis.
std::string map_plot(const FinishedTest& test, const char upwards)
{
  const auto& size = test.record.size;
  std::string text =
    fmt::format("set title {} noenhanced\n"
                "set size ratio -1\n"
                "set xlabel 'x [mm]'; set ylabel '{} [mm]'\n"
                "set xtics 10 nomirror; set ytics 10 nomirror; set border 3; set lmargin 10; set rmargin 10\n"
                "set xrange [{}:{}]; set yrange [{}:{}]\n"
                "set bmargin 7\n"
                "set key outside bottom center horizontal maxcols 2 Left reverse samplen 1 width -1\n",
                gnuplot_text(fmt::format("{}, seed {}: cracks at the end", title_of(test), test.record.seed)), upwards,
                -0.08 * size[0] / milli, 1.08 * size[0] / milli, -0.02 * size[1] / milli, 1.02 * size[1] / milli);
  const auto n_loose = std::count_if(test.appearance.grains_at_end.begin(), test.appearance.grains_at_end.end(),
                                     [](const GrainPicture& grain) { return grain.fragment > 0; });
  text += fmt::format("plot {} with circles fill solid noborder lc rgb '{}' title 'main body'", block("grains", test),
                      light_grey);
  if (n_loose > 0)
    text += fmt::format(", {} with circles fill solid noborder lc rgb '{}' title 'fragments'", block("loose", test),
                        single_grain_colour);
  const auto cracks = [&](const char* what, const char* colour, const std::uint64_t n) {
    if (n > 0)
      text +=
        fmt::format(", {} with vectors nohead lw 2 lc rgb '{}' title '{}: {}'", block(what, test), colour, what, n);
  };
  const auto n_drawn = [&](const CrackKind kind) {
    return std::uint64_t(std::count_if(test.record.cracks.begin(), test.record.cracks.end(),
                                       [kind](const Crack& crack) { return crack.kind == kind; }));
  };
  text += flaw_outlines(test, test.name).plots;
  cracks("tension", tension_colour, n_drawn(CrackKind::tension));
  cracks("shear", shear_colour, n_drawn(CrackKind::shear));
  return text + "\n";
}

} // namespace

std::vector<Picture> single_test_pictures(const Series& series)
{
  std::vector<Picture> pictures;
  for (const auto& test : series.tests)
    {
      if (test.record.curve.empty())
        continue; // it could not be made, or its curve is missing
      const bool is_measured = series.kind == SeriesKind::laboratory_curve;
      const std::string title = is_measured ? fmt::format("{}: {}", series.label, title_of(test)) : title_of(test);
      pictures.push_back({.name = test.name + "_stress_strain",
                          .caption = title,
                          .alternative = fmt::format("Stress against {}{}, {}.", test.record.kind.channel.strain_name,
                                                     is_measured ? "" : " and count of cracks", title),
                          .width = 900,
                          .height = 650,
                          .raster = true,
                          .script = curve_data(test) + (is_measured ? measured_plot(test, title) : curve_plot(test))});
      for (auto& map : crack_map(test, title))
        pictures.push_back(std::move(map));
    }
  return pictures;
}

std::vector<Picture> overview_picture(const Series& series)
{
  std::string data;
  std::string curves;
  std::string maps;
  int n_columns = 0;
  for (const auto& group : shown(groups_of(series)))
    if (FinishedTest test = *group.tests.front();
        !test.record.curve.empty() && test.record.body == TestBody::grains) // maps are of grains
      {
        const char upwards = test.record.dimension() == 2 ? 'y' : 'z';
        test = plane_view(std::move(test));
        data += curve_data(test) + map_data(test);
        curves += curve_plot(test);
        maps += map_plot(test, upwards);
        ++n_columns;
      }
  if (n_columns == 0)
    return {};
  return {{.name = "overview",
           .caption = "Curves and crack maps of the first specimen",
           .alternative = "Stress-strain curves above, crack maps below.",
           .width = 620 * n_columns,
           .height = 1250,
           .raster = true,
           .vector = false,
           .script = data + fmt::format("set multiplot layout 2,{}\n{}{}unset multiplot\n", n_columns, curves, maps)}};
}
} // namespace feldspar

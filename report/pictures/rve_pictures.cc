#include "report/pictures/rve_pictures.h"

#include "report/pictures/plot_style.h"
#include "report/pictures/space_pictures.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <utility>

namespace feldspar
{
using namespace plot;

std::string letter_of_rve(const std::size_t k) { return {char('A' + k)}; }

double broken_share(const PointRve& rve)
{
  return rve.n_segments > 0 ? double(rve.cracks.size()) / double(rve.n_segments) : 0.0;
}

std::string standing_of(const PointRve& rve, const SampleFields& fields)
{
  const auto& at = rve.position;
  if (fields.is_axisymmetric())
    return fmt::format("r = {:.1f} mm, z = {:.1f} mm", at[0] / milli, at[2] / milli);
  if (fields.dimension == 3)
    return fmt::format("({:.1f}, {:.1f}, {:.1f}) mm", at[0] / milli, at[1] / milli, at[2] / milli);
  const bool in_space = fields.has("crack_orientation_zz_per_m");
  return fmt::format("({:.1f}, {:.1f}) mm", at[0] / milli, at[in_space ? 2 : 1] / milli);
}

std::vector<Picture> rve_picture(const FinishedTest& test, const std::string& title)
{
  const auto& rves = test.appearance.rves;
  if (rves.empty() || std::any_of(rves.begin(), rves.end(), [](const auto& v) { return v.grains.empty(); }))
    return {};
  std::vector<std::string> headings;
  for (std::size_t k = 0; k < rves.size(); ++k)
    headings.push_back(fmt::format("{}: {}", letter_of_rve(k), rves[k].which));
  const std::string name = test.name + "_rves";
  const std::string caption =
    fmt::format("{}, seed {}: grains and cracks of the representative volumes at a few points of the "
                "sample, along its axes, at the end",
                title, test.record.seed);
  const std::string alternative = fmt::format("Grains and cracks of {} representative volumes of {} (seed {}).",
                                              rves.size(), title, test.record.seed);
  if (test.appearance.fields.dimension == 3 || test.appearance.fields.has("crack_orientation_zz_per_m"))
    {
      Picture picture = space_picture_of_rves(rves, headings);
      picture.name = name;
      picture.caption = caption +
                        ". Grains behind the mid-plane, every broken element as a disc; seen from the front, a "
                        "little from the right and from above";
      picture.alternative = alternative;
      return {picture};
    }

  std::string data;
  std::string plots;
  double reach = 0.0; // from an RVE's point
  for (const PointRve& rve : rves)
    for (std::size_t c = 0; c < 2; ++c)
      {
        for (const auto& grain : rve.grains)
          reach = std::max(reach, std::abs(grain.position[c] - rve.position[c]) + grain.radius);
        for (const auto& crack : rve.cracks)
          reach = std::max(reach, std::abs(crack.centroid[c] - rve.position[c]) + 0.5 * crack.size);
      }
  reach *= 1.03 / milli;
  for (std::size_t k = 0; k < rves.size(); ++k)
    {
      const auto& centre = rves[k].position;
      std::string body;
      std::string loose;
      for (const auto& grain : rves[k].grains)
        fmt::format_to(std::back_inserter(grain.fragment > 0 ? loose : body), "{:.6g} {:.6g} {:.6g}\n",
                       (grain.position[0] - centre[0]) / milli, (grain.position[1] - centre[1]) / milli,
                       grain.radius / milli);
      data += fmt::format("$grains{0} << EOD\n{1}EOD\n", k, body);
      plots +=
        fmt::format("set title {} noenhanced\nplot $grains{} with circles fill solid noborder lc rgb '{}' notitle",
                    gnuplot_text(headings[k]), k, light_grey);
      if (!loose.empty())
        {
          data += fmt::format("$loose{} << EOD\n{}EOD\n", k, loose);
          plots += fmt::format(", $loose{} with circles fill solid noborder lc rgb '{}' title 'cut off'", k,
                               single_grain_colour);
        }
      for (const CrackKind kind : {CrackKind::tension, CrackKind::shear})
        {
          std::string rows;
          for (const auto& crack : rves[k].cracks)
            if (crack.kind == kind)
              rows += trace_of(crack, 1, {centre[0], centre[1]});
          add_cracks(data, plots, k, kind, rows, 2.2);
        }
      if (rves[k].cracks.empty())
        plots += ", NaN with lines lc rgb '#ffffff' title 'nothing broken'";
      plots += "\n";
    }
  return {
    {.name = name,
     .caption =
       caption +
       ". Coordinates are from the point of the sample; the cell is periodic, so that cracks at its rim go on at "
       "the other side",
     .alternative = alternative,
     .width = 400 * int(rves.size()),
     .height = 480,
     .raster = true,
     .vector = false,
     .script =
       data +
       "set size ratio -1\nset xlabel 'x from the point [mm]' offset 0,0.4; set ylabel 'y from the point [mm]'\nset tics "
       "nomirror out; set border 3\nset key below center horizontal maxcols 3 Left reverse samplen 1.5 "
       "width 1 noenhanced\n" +
       fmt::format("set xrange [{0:.4g}:{1:.4g}]; set yrange [{0:.4g}:{1:.4g}]\nset multiplot layout 1,{2}\n"
                   "{3}unset multiplot\n",
                   -reach, reach, rves.size(), plots)}};
}
} // namespace feldspar

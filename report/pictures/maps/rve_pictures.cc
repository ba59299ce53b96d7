#include "base/append.h"
#include "report/pictures/figures.h"
#include "report/pictures/maps/map.h"
#include "report/pictures/maps/specimen_data.h"
#include "report/pictures/plot_style.h"
#include "report/pictures/rves.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>

namespace feldspar
{
using namespace plot;

namespace
{
/// Data by which the viewer shows RVEs as tests side by side, each with the curve of the sample.
std::string viewer_data(const FinishedTest& test, const std::vector<std::string>& headings, const bool in_space)
{
  const auto& rves = test.appearance.rves;
  std::vector<FinishedTest> shown(rves.size());
  std::vector<TitledTest> titled;
  for (std::size_t k = 0; k < rves.size(); ++k)
    {
      TestRecord& record = shown[k].record;
      record = test.record;
      record.cracks = rves[k].cracks;
      record.size[2] = in_space ? record.size[0] : 0.0;
      for (CurveSample& row : record.curve)
        {
          row.n_tension_cracks = row.n_shear_cracks = 0;
          for (const Crack& crack : record.cracks)
            if (crack.step <= row.step)
              ++(crack.kind == CrackKind::tension ? row.n_tension_cracks : row.n_shear_cracks);
        }
      shown[k].appearance.grains_at_end = rves[k].grains;
      titled.push_back({&shown[k], headings[k]});
    }
  return specimen_data(titled);
}
} // namespace

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

Pictures rve_picture(const FinishedTest& test, const std::string& title)
{
  const auto& rves = test.appearance.rves;
  if (rves.empty() || std::ranges::any_of(rves, [](const auto& v) { return v.grains.empty(); }))
    return {};
  std::vector<std::string> headings;
  for (std::size_t k = 0; k < rves.size(); ++k)
    headings.push_back(fmt::format("{}: {}", letter_of_rve(k), rves[k].which));
  const bool in_space =
    test.appearance.fields.dimension == 3 || test.appearance.fields.has("crack_orientation_zz_per_m");
  const std::string whose = fmt::format("{}, seed {}", title, test.record.seed);
  Picture picture{
    .name = test.name + "_rves",
    .caption = whose +
               ": grains and cracks of the representative volumes at a few points of the sample, along its axes, "
               "at the end",
    .alternative = fmt::format("Grains and cracks of {} representative volumes of {} (seed {}).", rves.size(), title,
                               test.record.seed),
    .raster = true,
    .vector = false,
    .story = viewer_data(test, headings, in_space),
    .live_caption =
      whose + ": cracks of the representative volumes up to the place of the slider, on the curve of the sample"};
  if (in_space)
    {
      picture.caption += ". Grains behind the mid-plane, every broken element as a disc; seen from the front, a little "
                         "from the right and from above";
      picture.width = 300 * int(rves.size());
      picture.height = 400;
      picture.body = picture.story;
      return {std::move(picture)};
    }

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
      const std::array<double, 2> centre{rves[k].position[0], rves[k].position[1]};
      Chart chart{
        .look = Chart::Look::map,
        .title = headings[k] + (rves[k].cracks.empty() ? ", nothing broken" : ""),
        .x = {.label = "x from the point [mm]", .from = -reach, .to = reach},
        .y = {.label = "y from the point [mm]", .from = -reach, .to = reach},
        .equal_scales = true,
        .key_columns = 3,
        .series = {grain_circles(rves[k].grains, false, centre), grain_circles(rves[k].grains, true, centre)}};
      chart.series.back().label = "cut off";
      append(chart.series, crack_traces(rves[k].cracks, 2.2, centre));
      picture.panels.push_back(std::move(chart));
    }
  picture.caption +=
    ". Coordinates are from the point of the sample; the cell is periodic, so that cracks at its rim go on at the other "
    "side";
  picture.width = 400 * int(rves.size());
  picture.height = 480;
  picture.columns = int(rves.size());
  return {std::move(picture)};
}
} // namespace feldspar

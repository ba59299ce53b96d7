#include "report/pictures/maps/crack_map.h"

#include "report/live/crack_story.h"
#include "report/live/group_colour.h"
#include "report/pictures/maps/damage_map.h"
#include "report/pictures/maps/map_frame.h"
#include "report/pictures/maps/map_marks.h"
#include "report/pictures/plot_style.h"

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
using namespace plot;

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

std::string stage_rows(const std::vector<Crack>& cracks, const std::size_t axis, const CrackKind kind,
                       const MapStage& stage)
{
  std::string rows;
  for (const auto& crack : cracks)
    if (crack.kind == kind && crack.step <= stage.last_step)
      rows += trace_of(crack, axis);
  return rows;
}

/// The order in which the first joints broke, to a map of that stage; those that broke later in grey.
void add_numbers(std::string& data, std::string& plots, const std::vector<Crack>& cracks, const std::size_t axis,
                 const MapStage& stage, const MapPaper& paper)
{
  const auto first = number_first_cracks(cracks, axis, paper);
  if (first.empty())
    return;
  std::string numbers;
  for (const auto& one : first)
    fmt::format_to(std::back_inserter(numbers), "{:.6g} {:.6g} {}\n", one.place[0] / milli, one.place[1] / milli,
                   one.number);
  std::string later;
  for (const auto& crack : cracks)
    if (crack.step > stage.last_step &&
        std::any_of(first.begin(), first.end(), [&](const auto& one) { return one.joint == crack.joint; }))
      later += trace_of(crack, axis);
  if (!later.empty())
    {
      data += fmt::format("$later << EOD\n{}EOD\n", later);
      plots += ", $later with vectors nohead lw 1.8 lc rgb '#707070' notitle";
    }
  data += fmt::format("$first << EOD\n{}EOD\n", numbers);
  plots += ", $first using 1:2:3 with labels font ',14' tc rgb '#101010' notitle";
}
} // namespace

std::vector<Picture> crack_map(const FinishedTest& test, const std::string& title)
{
  const TestRecord& record = test.record;
  if (record.body == TestBody::finite_elements)
    return damage_map(test, title);
  if (test.appearance.grains_at_end.empty() || record.curve.empty())
    return {};
  const std::size_t axis = vertical_axis(record);
  const auto all_stages = map_stages(record);
  const bool in_space = record.dimension() == 3;
  const MapFrame map_frame = map_frame_of(test);
  const MapLimits& frame = map_frame.frame;
  const std::vector<Crack> cracks_at_end = carried(test);
  const FlawOutlines flaws = flaw_outlines(test, "");
  const auto colours = group_colours(test.appearance.grains_at_end);
  std::string data = flaws.data;
  std::string plots;
  for (std::size_t s = 0; s < all_stages.size(); ++s)
    {
      const bool at_end = s + 1 == all_stages.size();
      std::string grains;
      for (std::size_t i = 0; i < colours.size(); ++i)
        {
          const GrainPicture& grain = test.appearance.grains_at_end[i];
          const auto& centre = at_end ? grain.position : grain.start;
          fmt::format_to(std::back_inserter(grains), "{:.6g} {:.6g} {:.6g} {}\n", centre[0] / milli,
                         centre[axis] / milli, grain.radius / milli, colours[i]);
        }
      data += fmt::format("$grains{} << EOD\n{}EOD\n", s, grains);
      plots += fmt::format("set title {} noenhanced\nplot $grains{} using 1:2:3:4 with circles fill solid noborder lc "
                           "rgb variable notitle",
                           gnuplot_text(all_stages[s].title), s);
      plots += flaws.plots;
      for (const CrackKind kind : {CrackKind::tension, CrackKind::shear})
        add_cracks(data, plots, s, kind, stage_rows(at_end ? cracks_at_end : record.cracks, axis, kind, all_stages[s]),
                   1.8);
      if (s == 0)
        add_numbers(data, plots, at_end ? cracks_at_end : record.cracks, axis, all_stages[s], paper_of(frame));
      plots += "\n";
    }
  const auto [width, height] = panel_size(frame);
  const int columns = is_long(frame) ? 1 : int(all_stages.size());
  const int rows = is_long(frame) ? int(all_stages.size()) : 1;
  return {{.name = test.name + "_cracks",
           .caption = fmt::format("{}, {}: cracks {}{}{}{}", title, seed_of(test), in_words(all_stages),
                                  in_space ? ", seen from the front through the whole body" : "",
                                  record.cracks.empty() ? "" : "; numbers: the order in which the first joints broke",
                                  map_frame.remark()),
           .alternative = fmt::format("Maps of the cracks of {} ({}): {} tension and {} shear cracks at the end.",
                                      title, seed_of(test), test.results.n_tension_cracks, test.results.n_shear_cracks),
           .width = width * columns,
           .height = height * rows,
           .raster = true,
           .vector = false,
           .script = data + map_set_up(frame, record) +
                     fmt::format("set multiplot layout {},{}\n{}unset multiplot\n", rows, columns, plots),
           .live = crack_story(test),
           .live_caption = fmt::format("{}, {}: segments broken up to the place of the slider{}", title, seed_of(test),
                                       in_space ? ", seen from the front through the whole body" : "")}};
}
} // namespace feldspar

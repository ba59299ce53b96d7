#include "report/pictures/crack_pictures.h"

#include "report/live/crack_story.h"
#include "report/pictures/map_marks.h"
#include "report/pictures/plot_style.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <iterator>
#include <limits>
#include <map>
#include <numbers>
#include <optional>
#include <utility>

namespace feldspar
{
namespace
{
using namespace plot;

constexpr double pi = std::numbers::pi;

/// The axis of the tests: the last one.
std::size_t vertical(const TestRecord& record) { return record.size[2] > 0.0 ? 2 : 1; }

/// Disc or sphere [m^dim]; a common factor.
double volume(const GrainPicture& grain, const std::size_t axis)
{
  return std::pow(grain.radius, axis == 2 ? 3.0 : 2.0);
}

/// Limits of a map, its margins the same for all stages of a test.
struct Frame
{
  std::array<double, 2> low{std::numeric_limits<double>::infinity(), std::numeric_limits<double>::infinity()};
  std::array<double, 2> high{-std::numeric_limits<double>::infinity(), -std::numeric_limits<double>::infinity()};

  double width() const { return high[0] - low[0]; }
  double height() const { return high[1] - low[1]; }

  std::string ranges() const
  {
    return fmt::format("set xrange [{:.6g}:{:.6g}]; set yrange [{:.6g}:{:.6g}]\n", low[0] / milli, high[0] / milli,
                       low[1] / milli, high[1] / milli);
  }
};

/// Around all grains as they lay at the start and where they came to. What flew farther than half the specimen's size is
/// left out, for it would make the specimen small.
struct MapFrame
{
  Frame frame;
  std::size_t n_outside = 0;

  std::string remark() const
  {
    return n_outside == 0 ? ""
                          : fmt::format("; {} grain{} flew out of the picture", n_outside, n_outside == 1 ? "" : "s");
  }
};

MapFrame frame_of(const FinishedTest& test)
{
  const TestRecord& record = test.record;
  const auto axis_of = [&](const std::size_t c) { return c == 0 ? 0 : vertical(record); };
  Frame start;
  for (const auto& grain : test.appearance.grains_at_end)
    for (std::size_t c = 0; c < 2; ++c)
      {
        start.low[c] = std::min(start.low[c], grain.start[axis_of(c)] - grain.radius);
        start.high[c] = std::max(start.high[c], grain.start[axis_of(c)] + grain.radius);
      }
  const std::array<double, 2> size{start.width(), start.height()};
  MapFrame result{start};
  for (const auto& grain : test.appearance.grains_at_end)
    {
      bool is_inside = true;
      for (std::size_t c = 0; c < 2; ++c)
        is_inside &= grain.position[axis_of(c)] > start.low[c] - 0.5 * size[c] &&
                     grain.position[axis_of(c)] < start.high[c] + 0.5 * size[c];
      result.n_outside += !is_inside;
      for (std::size_t c = 0; c < 2 && is_inside; ++c)
        {
          result.frame.low[c] = std::min(result.frame.low[c], grain.position[axis_of(c)] - grain.radius);
          result.frame.high[c] = std::max(result.frame.high[c], grain.position[axis_of(c)] + grain.radius);
        }
    }
  for (std::size_t c = 0; c < 2; ++c)
    {
      result.frame.low[c] -= 0.02 * size[c];
      result.frame.high[c] += 0.02 * size[c];
    }
  return result;
}

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

std::string map_set_up(const Frame& frame, const TestRecord& record)
{
  // Large letters: a phone shows the map at half its size or less.
  return fmt::format("set size ratio -1\nset xlabel 'x [mm]' font ',15'; set ylabel '{} [mm]' font ',15'\n"
                     "set xtics nomirror out font ',14'; set ytics nomirror out font ',14'; set border 3\n"
                     "set title font ',16'\nset key font ',14'\nset bmargin 7.5\n",
                     record.dimension() == 2 ? 'y' : 'z') +
         frame.ranges() + "set key below center horizontal maxcols 2 Left reverse samplen 1.5 width 1 noenhanced\n";
}

/// Whether panels stand better one below the other.
bool is_long(const Frame& frame) { return frame.width() > 1.5 * frame.height(); }

/// Pixels of a panel that is high enough for tics and key.
std::pair<int, int> panel_size(const Frame& frame)
{
  constexpr int inner_height = 620;
  const double ratio = frame.width() / frame.height();
  if (is_long(frame))
    return {1100, std::max(160, int(990.0 / ratio)) + 170};
  return {std::max(300, int(inner_height * ratio) + 110), inner_height + 170};
}

MapPaper paper_of(const Frame& frame)
{
  constexpr double pixels_of_letter = 17.0;
  return {frame.low, frame.high, pixels_of_letter * (is_long(frame) ? frame.width() / 990.0 : frame.height() / 620.0)};
}

/// A stage of a test: cracks up to a step.
struct Stage
{
  std::string title;
  std::uint64_t last_step;
};

std::vector<Stage> stages(const TestRecord& record)
{
  std::vector<Stage> result;
  if (const auto peak = peak_row(record))
    {
      if (const auto initiation = crack_initiation_row(record, *peak))
        result.push_back({"crack initiation", record.curve[*initiation].step});
      result.push_back({"peak", record.curve[*peak].step});
    }
  result.push_back({"end", std::numeric_limits<std::uint64_t>::max()});
  return result;
}

/// At which stages: "at the peak and at the end".
std::string in_words(const std::vector<Stage>& all)
{
  std::string text;
  for (std::size_t k = 0; k < all.size(); ++k)
    text += (k == 0                ? ""
             : k + 1 == all.size() ? " and "
                                   : ", ") +
            (all[k].title == "crack initiation" ? "at " + all[k].title : "at the " + all[k].title);
  return text;
}

std::string stage_rows(const std::vector<Crack>& cracks, const std::size_t axis, const CrackKind kind,
                       const Stage& stage)
{
  std::string rows;
  for (const auto& crack : cracks)
    if (crack.kind == kind && crack.step <= stage.last_step)
      rows += trace_of(crack, axis);
  return rows;
}

/// The order in which the first joints broke, to a map of that stage; those that broke later in grey.
void add_numbers(std::string& data, std::string& plots, const std::vector<Crack>& cracks, const std::size_t axis,
                 const Stage& stage, const MapPaper& paper)
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

/// Equivalent diameter of each fragment: of the circle or sphere of its grains' volume [m].
std::map<std::uint32_t, double> fragment_diameters(const FinishedTest& test)
{
  const std::size_t axis = vertical(test.record);
  std::map<std::uint32_t, double> diameters;
  for (const auto& grain : test.appearance.grains_at_end)
    diameters[grain.fragment] += volume(grain, axis);
  for (auto& [number, diameter] : diameters)
    diameter = 2.0 * std::pow(diameter, axis == 2 ? 1.0 / 3.0 : 0.5);
  return diameters;
}

std::string seed_of(const FinishedTest& test) { return fmt::format("seed {}", test.record.seed); }

/// Broken segments of the volume at one point of a sample.
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
        point.place = {crack.centroid[0], crack.centroid[vertical(record)]};
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

/// Circles at the points: area by the number of broken segments, the inner one of those broken in shear.
std::vector<Picture> damage_map(const FinishedTest& test, const std::string& title)
{
  const TestRecord& record = test.record;
  if (record.cracks.empty() || record.curve.empty())
    return {};
  const auto all_stages = stages(record);
  const auto at_end = damage(record, all_stages.back().last_step);
  std::size_t most = 0;
  for (const auto& [number, point] : at_end)
    most = std::max(most, point.n());
  const double largest_radius = room_for_circles(at_end, record);
  const auto radius = [&](const std::size_t n) { return largest_radius * std::sqrt(double(n) / double(most)); };

  Frame frame;
  const double height = record.size[vertical(record)];
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
} // namespace

namespace
{
/// As gnuplot counts colours; pale, so that cracks stand out. Neighbours in number are seldom neighbours in place.
unsigned int mineral_colour(const std::uint32_t mineral)
{
  static constexpr std::array tones{0xead9b8u, 0xc3d6e6u, 0xd9c7deu, 0xcfe2c3u, 0xe9c9c0u, 0xe3e3d0u, 0xbfd8d2u};
  return mineral == 0 ? 0xd8d8d8u : tones[mineral % tones.size()];
}
} // namespace

std::vector<Picture> crack_map(const FinishedTest& test, const std::string& title)
{
  const TestRecord& record = test.record;
  if (record.body == TestBody::finite_elements)
    return damage_map(test, title);
  if (test.appearance.grains_at_end.empty() || record.curve.empty())
    return {};
  const std::size_t axis = vertical(record);
  const auto all_stages = stages(record);
  const bool in_space = record.dimension() == 3;
  const MapFrame map_frame = frame_of(test);
  const Frame& frame = map_frame.frame;
  const std::vector<Crack> cracks_at_end = carried(test);
  const FlawOutlines flaws = flaw_outlines(test, "");
  std::string data = flaws.data;
  std::string plots;
  for (std::size_t s = 0; s < all_stages.size(); ++s)
    {
      const bool at_end = s + 1 == all_stages.size();
      std::string grains;
      for (const auto& grain : test.appearance.grains_at_end)
        {
          const auto& centre = at_end ? grain.position : grain.start;
          fmt::format_to(std::back_inserter(grains), "{:.6g} {:.6g} {:.6g} {}\n", centre[0] / milli,
                         centre[axis] / milli, grain.radius / milli, mineral_colour(grain.mineral));
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
           .live = crack_story(test)}};
}

std::vector<Picture> fragment_map(const FinishedTest& test, const std::string& title)
{
  const TestRecord& record = test.record;
  if (test.appearance.grains_at_end.empty())
    return {};
  const std::size_t axis = vertical(record);
  const MapFrame map_frame = frame_of(test);
  const Frame& frame = map_frame.frame;
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

std::vector<Picture> rose_picture(const Series& series)
{
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
          const std::size_t axis = vertical(test->record);
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
            const double of_fragment = std::pow(diameter, vertical(test->record) == 2 ? 3.0 : 2.0);
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

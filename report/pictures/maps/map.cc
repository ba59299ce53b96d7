#include "report/pictures/maps/map.h"

#include "report/pictures/plot_style.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <set>

namespace feldspar
{
using namespace plot;

namespace
{
using Point = std::array<double, 2>;

double least_distance(const Point& from, const std::vector<Point>& points)
{
  double least = std::numeric_limits<double>::infinity();
  for (const Point& point : points)
    least = std::min(least, std::hypot(point[0] - from[0], point[1] - from[1]));
  return least;
}
/// A letter beyond the axes would not be drawn.
bool holds(const MapPaper& paper, const Point& place)
{
  const double half = 0.5 * paper.letter;
  return place[0] - half > paper.low[0] && place[0] + half < paper.high[0] && place[1] - half > paper.low[1] &&
         place[1] + half < paper.high[1];
}
} // namespace

std::vector<ChartSeries> flaw_lines(const FinishedTest& test)
{
  ChartSeries open{.colour = "#202020", .width = 1.2};
  ChartSeries closed{.label = "flaw", .colour = "#202020", .width = 3.0};
  for (const auto& flaw : test.appearance.flaws)
    {
      auto& points = (flaw.open ? open : closed).points;
      for (const auto& point : flaw.outline)
        points.push_back({point[0] / milli, point[1] / milli});
      points.push_back(gap);
    }
  return {open, closed};
}

ChartSeries grain_circles(const std::vector<GrainPicture>& grains, const bool loose,
                          const std::array<double, 2>& origin)
{
  ChartSeries circles{.kind = ChartSeries::Kind::circles, .colour = loose ? single_grain_colour : light_grey};
  for (const GrainPicture& grain : grains)
    if ((grain.fragment > 0) == loose)
      circles.points.push_back(
        {(grain.position[0] - origin[0]) / milli, (grain.position[1] - origin[1]) / milli, grain.radius / milli});
  return circles;
}

ChartPoint trace_of(const Crack& crack, const std::array<double, 2>& origin)
{
  const double dx = -crack.normal[1] * crack.size;
  const double dy = crack.normal[0] * crack.size;
  return {(crack.centroid[0] - origin[0] - 0.5 * dx) / milli, (crack.centroid[1] - origin[1] - 0.5 * dy) / milli,
          dx / milli, dy / milli};
}

std::vector<ChartSeries> crack_traces(const std::vector<Crack>& cracks, const double width,
                                      const std::array<double, 2>& origin)
{
  ChartSeries tension{.kind = ChartSeries::Kind::segments, .colour = tension_colour, .width = width};
  ChartSeries shear{.kind = ChartSeries::Kind::segments, .colour = shear_colour, .width = width};
  for (const Crack& crack : cracks)
    (crack.kind == CrackKind::tension ? tension : shear).points.push_back(trace_of(crack, origin));
  tension.label = fmt::format("tension: {}", tension.points.size());
  shear.label = fmt::format("shear: {}", shear.points.size());
  return {tension, shear};
}

std::vector<NumberedCrack> number_first_cracks(const std::vector<Crack>& cracks, const MapPaper& paper)
{
  constexpr std::size_t most = 10; // more would cover one another
  std::vector<NumberedCrack> result;
  std::vector<Point> taken; // by cracks and, later, by numbers
  std::set<std::uint64_t> joints;
  std::uint64_t step_before = 0;
  for (const Crack& crack : cracks)
    if (result.size() < most && joints.insert(crack.joint).second)
      {
        const bool at_once = !result.empty() && crack.step == step_before;
        result.push_back(
          {crack.joint, at_once ? result.back().number : joints.size(), {crack.centroid[0], crack.centroid[1]}});
        taken.push_back(result.back().place);
        step_before = crack.step;
      }

  for (std::size_t k = 0; k < result.size(); ++k)
    {
      const Point crack = taken[k];
      // A place as far from its own crack everywhere; the others decide.
      std::vector<Point> others = taken;
      others.erase(others.begin() + std::ptrdiff_t(k));
      constexpr int n_directions = 8;
      double farthest = -1.0;
      for (int d = 0; d < n_directions; ++d)
        {
          const double angle = 2.0 * std::numbers::pi * (d + 0.5) / n_directions;
          const double arm = 1.2 * paper.letter;
          const Point place{crack[0] + arm * std::cos(angle), crack[1] + arm * std::sin(angle)};
          if (const double distance = least_distance(place, others); distance > farthest && holds(paper, place))
            {
              farthest = distance;
              result[k].place = place;
            }
        }
      taken.push_back(result[k].place);
    }
  return result;
}

std::size_t vertical_axis(const TestRecord& record) { return record.size[2] > 0.0 ? 2 : 1; }

std::string seed_of(const FinishedTest& test) { return fmt::format("seed {}", test.record.seed); }

std::string MapFrame::remark() const
{
  return n_outside == 0 ? ""
                        : fmt::format("; {} grain{} flew out of the picture", n_outside, n_outside == 1 ? "" : "s");
}

MapFrame map_frame_of(const FinishedTest& test)
{
  const std::size_t axis = vertical_axis(test.record);
  MapLimits start;
  for (const auto& grain : test.appearance.grains_at_end)
    start.include({grain.start[0], grain.start[axis]}, grain.radius);
  MapFrame result{start};
  for (const auto& grain : test.appearance.grains_at_end)
    {
      const std::array<double, 2> place{grain.position[0], grain.position[axis]};
      bool is_inside = true;
      for (std::size_t c = 0; c < 2; ++c)
        is_inside &= place[c] > start.low[c] - 0.5 * start.size(c) && place[c] < start.high[c] + 0.5 * start.size(c);
      if (is_inside)
        result.frame.include(place, grain.radius);
      else
        ++result.n_outside;
    }
  for (std::size_t c = 0; c < 2; ++c)
    {
      result.frame.low[c] -= 0.02 * start.size(c);
      result.frame.high[c] += 0.02 * start.size(c);
    }
  return result;
}

Chart empty_map(const MapLimits& frame, const TestRecord& record, const std::string& title)
{
  return {.look = Chart::Look::large_map,
          .title = title,
          .x = {.label = "x [mm]", .from = frame.low[0] / milli, .to = frame.high[0] / milli},
          .y = {.label = record.dimension() == 2 ? "y [mm]" : "z [mm]",
                .from = frame.low[1] / milli,
                .to = frame.high[1] / milli},
          .equal_scales = true,
          .key_columns = 2};
}

bool is_long(const MapLimits& frame) { return frame.size(0) > 1.5 * frame.size(1); }

std::pair<int, int> panel_size(const MapLimits& frame)
{
  constexpr int inner_height = 620;
  const double ratio = frame.size(0) / frame.size(1);
  if (is_long(frame))
    return {1100, std::max(160, int(990.0 / ratio)) + 170};
  return {std::max(300, int(inner_height * ratio) + 110), inner_height + 170};
}

MapPaper paper_of(const MapLimits& frame)
{
  constexpr double pixels_of_letter = 17.0;
  return {frame.low, frame.high, pixels_of_letter * (is_long(frame) ? frame.size(0) / 990.0 : frame.size(1) / 620.0)};
}

std::vector<MapStage> map_stages(const TestRecord& record)
{
  std::vector<MapStage> result;
  if (const auto peak = peak_row(record))
    {
      if (const auto initiation = crack_initiation_row(record, *peak))
        result.push_back({"crack initiation", record.curve[*initiation].step});
      result.push_back({"peak", record.curve[*peak].step});
    }
  result.push_back({"end", std::numeric_limits<std::uint64_t>::max()});
  return result;
}

std::string in_words(const std::vector<MapStage>& all)
{
  std::string text;
  for (std::size_t k = 0; k < all.size(); ++k)
    text += (k == 0                ? ""
             : k + 1 == all.size() ? " and "
                                   : ", ") +
            (all[k].title == "crack initiation" ? "at " + all[k].title : "at the " + all[k].title);
  return text;
}
} // namespace feldspar

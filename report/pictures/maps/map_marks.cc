#include "report/pictures/maps/map_marks.h"

#include "report/pictures/plot_style.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <limits>
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

FlawOutlines flaw_outlines(const FinishedTest& test, const std::string& owner)
{
  constexpr const char* colour = "#202020";
  const std::size_t axis = test.record.size[2] > 0.0 ? 2 : 1;
  FlawOutlines outlines;
  const auto add = [&](const bool open, const char* const name, const std::string& style) {
    std::string rows;
    for (const auto& flaw : test.appearance.flaws)
      if (flaw.open == open)
        {
          for (const auto& point : flaw.outline)
            fmt::format_to(std::back_inserter(rows), "{:.6g} {:.6g}\n", point[0] / milli, point[axis] / milli);
          rows += "\n";
        }
    if (rows.empty())
      return;
    const std::string block = data_block(name, owner);
    outlines.data += fmt::format("{} << EOD\n{}EOD\n", block, rows);
    outlines.plots += fmt::format(", {} using 1:2 with lines {}", block, style);
  };
  add(true, "open", fmt::format("lw 1.2 lc rgb '{}' notitle", colour));
  add(false, "closed", fmt::format("lw 3 lc rgb '{}' title 'flaw'", colour));
  return outlines;
}

std::vector<NumberedCrack> number_first_cracks(const std::vector<Crack>& cracks, const std::size_t axis,
                                               const MapPaper& paper)
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
          {crack.joint, at_once ? result.back().number : joints.size(), {crack.centroid[0], crack.centroid[axis]}});
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
} // namespace feldspar

#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <limits>
#include <optional>
#include <string>
#include <vector>

/// Figures as plain data: axes, series and legend. Two writers draw them: report/chart/gnuplot_writer.h for files,
/// report/chart/page_writer.h for the script of the page.
namespace feldspar
{
/// Abscissa, ordinate and two numbers with a meaning by the kind of the series.
using ChartPoint = std::array<double, 4>;

/// Separator of points: a gap in a line, or the end of one area and the beginning of the next.
inline constexpr ChartPoint gap{std::numeric_limits<double>::quiet_NaN(), std::numeric_limits<double>::quiet_NaN()};

/// Limits of places along each of some axes; turned round while no place is within them.
template <std::size_t n>
struct Limits
{
  std::array<double, n> low;
  std::array<double, n> high;

  Limits()
  {
    low.fill(std::numeric_limits<double>::infinity());
    high.fill(-std::numeric_limits<double>::infinity());
  }

  double size(const std::size_t axis) const { return high[axis] - low[axis]; }

  /// Widens the limits until they have a circle or sphere in them.
  void include(const std::array<double, n>& place, const double radius = 0.0)
  {
    for (std::size_t c = 0; c < n; ++c)
      {
        low[c] = std::min(low[c], place[c] - radius);
        high[c] = std::max(high[c], place[c] + radius);
      }
  }
};

struct ChartSeries
{
  enum class Kind
  {
    line,
    steps,
    marks,
    marked_line, ///< both
    area,        ///< within closed lines, with a gap after each
    circles,     ///< third number: the radius
    segments,    ///< third and fourth number: from the point so far along each axis
    texts
  };

  /// Bars at marks; third and fourth number: their ends on the axis that they lie along.
  enum class Bars
  {
    none,
    along_x,
    along_y
  };

  enum class Colours
  {
    one,
    by_value, ///< fourth number: a place on the colour axis; of an area that of its first corner
    own       ///< fourth number: 0xRRGGBB
  };

  Kind kind = Kind::line;
  std::string label = {};     ///< in the key
  std::string goes_with = {}; ///< label of the series that it comes and goes with; then it is not in the key itself
  std::string colour = {};    ///< #rrggbb
  Colours colours = Colours::one;
  Bars bars = Bars::none;
  double width = 2.2;        ///< of lines [px]; a line thinner than 1 lets others through
  int dashes = 1;            ///< as gnuplot counts them: 1 is solid
  int mark = 7;              ///< as gnuplot counts them: 7 is a disc
  double size = 0.8;         ///< of marks, times gnuplot's; of texts [pt]
  double opacity = 1.0;      ///< of areas
  std::string rim = {};      ///< colour of the outline of circles and areas; empty: none
  bool to_the_right = false; ///< on the axis there
  std::vector<ChartPoint> points = {};
  std::vector<std::string> texts = {}; ///< one for each point
};

struct ChartAxis
{
  std::string label = {};          ///< with the unit; empty on the right: no axis there
  std::optional<double> from = {}; ///< none: where the points begin
  std::optional<double> to = {};   ///< none: where the points end
  double room = 0.0;               ///< beside the points, as a share of the axis
  bool logarithmic = false;
  bool bare = false;              ///< without marks and numbers
  double step = 0.0;              ///< between numbers; 0: as many as have room
  std::vector<double> ticks = {}; ///< numbers; empty: by the step
};

/// A panel of a figure.
struct Chart
{
  enum class Look
  {
    plot,
    sheet,     ///< a curve for itself, without grid
    map,       ///< of a body
    large_map, ///< with large letters: a phone shows it at half its size or less
    matrix     ///< one of many small ones
  };

  Look look = Look::plot;
  std::string title = {};
  ChartAxis x = {};
  ChartAxis y = {};
  ChartAxis right = {};
  ChartAxis colour = {};
  std::vector<std::string> palette = {}; ///< colours from the lower to the upper end of the colour axis
  bool equal_scales = false;             ///< of both axes, so that a circle is one
  int key_columns = 0;                   ///< of the key, at most; 0: columns of five rows, as many as have room
  std::vector<ChartSeries> series = {};  ///< in the order in which they are drawn; those without points are left out

  bool empty() const
  {
    return std::ranges::all_of(series, [](const ChartSeries& one) { return one.points.empty(); });
  }
};
} // namespace feldspar

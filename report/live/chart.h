#pragma once

#include <array>
#include <limits>
#include <optional>
#include <string>
#include <vector>

/// What the script of the page (report/page/page.js) draws in the place of a picture: the same points, with their values
/// under the pointer.
namespace feldspar
{
/// Where a line has a gap.
inline constexpr std::array<double, 2> gap{std::numeric_limits<double>::quiet_NaN(),
                                           std::numeric_limits<double>::quiet_NaN()};

/// A line, or what goes with one.
struct ChartLine
{
  enum class Kind
  {
    line,
    steps,
    area,  ///< within a closed line
    marks, ///< points without a line
    bars   ///< errors: pairs of points with a gap after each
  };

  Kind kind = Kind::line;
  std::string label;          ///< in the key
  std::string goes_with = {}; ///< label of the line that it comes and goes with; then it is not in the key itself
  std::string colour = {};    ///< #rrggbb
  double width = 2.2;         ///< [px]
  int dashes = 1;             ///< as gnuplot counts them: 1 is solid
  int mark = 7;               ///< as gnuplot counts them: 7 is a disc
  bool to_the_right = false;  ///< on the axis there
  std::vector<std::array<double, 2>> points = {};
};

/// Axes and lines, in the units of their labels.
struct Chart
{
  std::string x_label;
  std::string y_label;
  std::string right_label = {};                   ///< of the axis to the right; empty without one
  bool from_zero = true;                          ///< the axes of ordinates begin there
  bool equal_scales = false;                      ///< of both axes, so that a circle is one
  std::optional<std::array<double, 4>> part = {}; ///< shown of the plane: from and to on x, then on y; none: all
  std::vector<ChartLine> lines = {};

  /// Five digits of each number, `null` in gaps; no `<` in it, so that it may stand in a page.
  std::string json() const;
};

namespace live
{
/// As a string of JSON, in quotes; what is not UTF-8 replaced, `<` written so that no tag can begin.
std::string text(const std::string& words);

/// With so many digits, or null.
std::string number(double value, int digits = 5);
} // namespace live
} // namespace feldspar

#include "report/chart/gnuplot_writer.h"

#include "base/quoted.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <utility>

namespace feldspar
{
namespace
{
using Kind = ChartSeries::Kind;
using Bars = ChartSeries::Bars;
using Colours = ChartSeries::Colours;

/// Settings of gnuplot for a look.
struct Paper
{
  const char* set_up;
  const char* key;
  const char* tics;
  const char* x_label; ///< how it is written
  const char* y_label;
};

/// In the order of Chart::Look.
constexpr Paper papers[] = {
  {"set grid lw 0.5 lc rgb '#e4e4e4'\nset xzeroaxis lt 1 lw 0.8 lc rgb '#b0b0b0'\n"
   "set yzeroaxis lt 1 lw 0.8 lc rgb '#b0b0b0'\n",
   "below center horizontal Left reverse samplen 2.2 spacing 1.1 height 0.8", "nomirror out", "offset 0,0.4", ""},
  {"set lmargin 10; set rmargin 14; set bmargin 6\n", "outside bottom center horizontal Left reverse samplen 2 width 1",
   "nomirror in", "", ""},
  {"", "below center horizontal Left reverse samplen 1.5 width 1", "nomirror out", "offset 0,0.4", ""},
  {"set title font ',16'\nset bmargin 7.5\n", "below center horizontal Left reverse samplen 1.5 width 1 font ',14'",
   "nomirror out font ',14'", "font ',15'", "font ',15'"},
  {"set autoscale xfix\nset lmargin 9; set rmargin 1; set tmargin 0.6; set bmargin 3\n", "off", "nomirror out",
   "offset 0,0.6 font ',9'", "offset 1.2,0 font ',8'"}};

/// Entries of a key, and the letters of the longest.
std::pair<int, int> size_of_key(const Chart& chart)
{
  int n = 0;
  int longest = 0;
  for (const ChartSeries& series : chart.series)
    if (!series.points.empty() && !series.label.empty() && series.goes_with.empty())
      {
        ++n;
        // Bytes that go on with a character of UTF-8 begin with the bits 10.
        longest =
          std::max(longest, int(std::ranges::count_if(series.label, [](const char c) { return (c & 0xC0) != 0x80; })));
      }
  return {n, longest};
}

constexpr int usual_rows = 5;

/// Number of rows of a key. Where labels are too long for columns of the usual rows side by side, there are fewer
/// columns with more rows: gnuplot would draw the rest beyond the edge of the picture.
int rows_of_key(const Chart& chart, const int width)
{
  // Width that gnuplot computes for a column, and limit of how far columns may stick out: it takes letters for wider
  // than they are.
  constexpr double letter = 8.4, mark = 53.0, reach = 1.08;
  const auto [n, longest] = size_of_key(chart);
  const int n_columns = std::max(1, int(reach * width / (letter * longest + mark)));
  return std::max(usual_rows, (n + n_columns - 1) / n_columns);
}

std::string range(const ChartAxis& axis)
{
  const auto end = [](const std::optional<double>& value) { return value ? fmt::format("{:.6g}", *value) : "*"; };
  return fmt::format("[{}:{}]", end(axis.from), end(axis.to));
}

std::string ticks(const ChartAxis& axis)
{
  return !axis.ticks.empty() ? fmt::format("({:g})", fmt::join(axis.ticks, ","))
         : axis.step > 0.0   ? fmt::format("{:g}", axis.step)
                             : "autofreq";
}

/// name: x, y, y2 or cb.
std::string settings(const char* const name, const ChartAxis& axis, const char* const label, const char* const tics)
{
  return fmt::format("set {0}label {1} noenhanced {2}\nset {0}range {3}\n{4} logscale {0}\n", name,
                     gnuplot_text(axis.label), label, range(axis), axis.logarithmic ? "set" : "unset") +
         (axis.bare ? fmt::format("unset {}tics\n", name) : fmt::format("set {}tics {} {}\n", name, tics, ticks(axis)));
}

std::string settings(const Chart& chart, const int width)
{
  const Paper& paper = papers[std::size_t(chart.look)];
  const bool has_right = !chart.right.label.empty();
  std::string text = fmt::format("set title {} noenhanced\nset size {}\nset border {} lw 0.8\n",
                                 gnuplot_text(chart.title), chart.equal_scales ? "ratio -1" : "noratio",
                                 chart.x.bare && chart.y.bare ? 0
                                 : has_right                  ? 11
                                                              : 3);
  text += paper.set_up + settings("x", chart.x, paper.x_label, paper.tics) +
          settings("y", chart.y, paper.y_label, paper.tics);
  text += has_right ? settings("y2", chart.right, paper.y_label, paper.tics) : "unset y2label; unset y2tics\n";
  text += fmt::format("set offsets graph {0}, graph {0}, graph {1}, graph {1}\nset key {2} noenhanced", chart.x.room,
                      chart.y.room, paper.key);
  text += chart.key_columns > 0 ? fmt::format(" maxcols {}\n", chart.key_columns)
                                : fmt::format("\nset key vertical maxrows {}\n", rows_of_key(chart, width));
  if (chart.palette.empty())
    return text;
  std::string colours;
  for (std::size_t k = 0; k < chart.palette.size(); ++k)
    colours += fmt::format("{}{} '{}'", k ? ", " : "", k, chart.palette[k]);
  return text + fmt::format("unset grid\nset palette defined ({})\n", colours) +
         settings("cb", chart.colour, "", paper.tics);
}

bool is_gap(const ChartPoint& point) { return !std::isfinite(point[0]) || !std::isfinite(point[1]); }

/// The numbers of a point that gnuplot is given.
std::vector<std::size_t> columns_of(const ChartSeries& series)
{
  std::vector<std::size_t> columns{0, 1};
  if (series.kind == Kind::circles || series.kind == Kind::segments || series.bars != Bars::none)
    columns.push_back(2);
  if (series.kind == Kind::segments || series.bars != Bars::none || series.colours != Colours::one)
    columns.push_back(3);
  return columns;
}

std::string rows(const ChartSeries& series)
{
  const std::vector<std::size_t> columns = columns_of(series);
  std::string text;
  for (const ChartPoint& point : series.points)
    {
      for (const std::size_t c : columns)
        if (!is_gap(point))
          fmt::format_to(std::back_inserter(text), "{}{:.{}g}", c == 0 ? "" : " ", point[c],
                         c == 3 && series.colours == Colours::own ? 8 : 6);
      text += '\n';
    }
  return text;
}

/// Style of a series in a plot beside its colour.
std::string style(const ChartSeries& series)
{
  const std::string line = fmt::format(" lw {} dt {}", series.width, series.dashes);
  const std::string mark = fmt::format(" pt {} ps {}", series.mark, series.size);
  const std::string fill = fmt::format(" fill solid {} {}", series.opacity,
                                       series.rim.empty() ? "noborder" : fmt::format("border lc rgb '{}'", series.rim));
  const char* const axis = series.bars == Bars::along_x ? "x" : "y";
  const bool has_bars = series.bars != Bars::none;
  switch (series.kind)
    {
    case Kind::line:
      return "lines" + line;
    case Kind::steps:
      return "histeps" + line;
    case Kind::marks:
      return (has_bars ? fmt::format("{}errorbars", axis) : "points") + mark + fmt::format(" lw {}", series.width);
    case Kind::marked_line:
      return (has_bars ? fmt::format("{}errorlines", axis) : "linespoints") + line + mark;
    case Kind::area:
      return "filledcurves closed" + fill;
    case Kind::circles:
      return "circles" + fill;
    default:
      return fmt::format("vectors nohead lw {}", series.width);
    }
}

/// A script in the making.
class Script
{
public:
  std::string data; ///< of all panels: a block of data cannot stand between them
  std::string commands;

  void add_panel(const Chart& chart, const int width)
  {
    commands += "unset object; unset label; set margins -1, -1, -1, -1\n" + settings(chart, width);
    plots.clear();
    for (const ChartSeries& series : chart.series)
      if (series.points.empty())
        continue;
      else if (series.kind == Kind::texts)
        add_texts(series);
      else if (series.kind == Kind::area && series.colours == Colours::by_value)
        add_coloured_areas(series);
      else
        add_plot(series);
    commands += "plot " + (plots.empty() ? "NaN notitle" : plots) + "\n";
  }

private:
  void add_plot(const ChartSeries& series)
  {
    std::string colour = series.colours == Colours::by_value ? "palette"
                         : series.colours == Colours::own    ? "rgb variable"
                                                             : fmt::format("rgb '{}'", series.colour);
    if (series.kind == Kind::line && series.width < 1.0)
      colour.insert(colour.find('#') + 1, "90");
    std::string uses = "1";
    for (std::size_t k = 2; k <= columns_of(series).size(); ++k)
      uses += fmt::format(":{}", k);
    const bool has_key = series.goes_with.empty() && !series.label.empty();
    add(rows(series),
        fmt::format("using {} {}with {} lc {} {}", uses, series.to_the_right ? "axes x1y2 " : "", style(series), colour,
                    has_key ? fmt::format("title {} noenhanced", gnuplot_text(series.label)) : "notitle"));
  }

  void add_texts(const ChartSeries& series)
  {
    for (std::size_t k = 0; k < series.points.size(); ++k)
      commands += fmt::format("set label {} at {:.6g},{:.6g} center front noenhanced font ',{}' tc rgb '{}'\n",
                              gnuplot_text(series.texts[k]), series.points[k][0], series.points[k][1], series.size,
                              series.colour);
  }

  /// Adds areas as objects, which may have any corners. gnuplot draws the bar of a palette for plots only; a dot in the
  /// middle of each area is one.
  void add_coloured_areas(const ChartSeries& series)
  {
    std::string dots;
    for (auto first = series.points.begin(); first != series.points.end();)
      {
        const auto end = std::find_if(first, series.points.end(), is_gap);
        std::array<double, 2> middle{};
        std::string corners;
        for (auto corner = first; corner != end; ++corner)
          {
            corners += fmt::format("{:.6g},{:.6g} to ", (*corner)[0], (*corner)[1]);
            for (std::size_t c = 0; c < 2; ++c)
              middle[c] += (*corner)[c] / double(end - first);
          }
        const double value = (*first)[3];
        commands += fmt::format("set object polygon from {}{:.6g},{:.6g} behind fc palette cb {:.6g} fs solid {}\n",
                                corners, (*first)[0], (*first)[1], value,
                                series.rim.empty() ? "noborder" : fmt::format("border lc rgb '{}' lw 0.4", series.rim));
        fmt::format_to(std::back_inserter(dots), "{:.6g} {:.6g} {:.6g}\n", middle[0], middle[1], value);
        first = end == series.points.end() ? end : end + 1;
      }
    add(dots, "using 1:2:3 with dots lc palette notitle");
  }

  void add(const std::string& its_rows, const std::string& its_plot)
  {
    data += fmt::format("$data{} << EOD\n{}EOD\n", n_blocks, its_rows);
    plots += fmt::format("{}$data{} {}", plots.empty() ? "" : ", \\\n", n_blocks, its_plot);
    ++n_blocks;
  }

  std::string plots; ///< of the last panel
  int n_blocks = 0;
};
} // namespace

std::string gnuplot_script(const std::vector<Chart>& panels, const int columns, const int width)
{
  Script script;
  for (const Chart& chart : panels)
    if (chart.empty() && chart.title.empty())
      script.commands += "set multiplot next\n";
    else
      script.add_panel(chart, width / columns);
  if (panels.size() == 1)
    return script.data + script.commands;
  return script.data + fmt::format("set multiplot layout {},{} rowsfirst\n{}unset multiplot\n",
                                   (int(panels.size()) + columns - 1) / columns, columns, script.commands);
}

int further_height(const Chart& chart, const int width)
{
  constexpr int row = 23; // [px]
  if (chart.key_columns == 0)
    return row * (rows_of_key(chart, width) - usual_rows);
  constexpr double letter = 8.0; // [px]
  constexpr int mark = 6;        // before each label, in letters
  constexpr int rows_with_room = 2;
  const auto [n, longest] = size_of_key(chart);
  const int n_columns = std::clamp(int(width / letter) / (longest + mark), 1, chart.key_columns);
  return row * std::max(0, (n + n_columns - 1) / n_columns - rows_with_room);
}

std::string gnuplot_text(const std::string_view text)
{
  // Gnuplot reads everything between single quotes as text, except the quote itself. Doubling it is not enough: of
  // three in a row the second ends the string. Therefore the typographic quote stands for it.
  std::string result = "'";
  for (const char c : printable(text))
    {
      // SVG of gnuplot has "]]>" unchanged, which is no XML.
      if (c == '>' && result.ends_with("]]"))
        result += ' ';
      result += c == '\'' ? std::string("’") : std::string(1, c);
    }
  return result + "'";
}
} // namespace feldspar

#pragma once

#include "report/live/chart.h"
#include "report/pictures/plot_style.h"

#include <fmt/format.h>

#include <iterator>
#include <string>
#include <utility>

namespace feldspar::plot
{
/// Lines and points of a picture and of the page alike.
class PlanePlot
{
public:
  explicit PlanePlot(Chart axes)
    : chart(std::move(axes))
  {
  }

  void add(ChartLine line)
  {
    if (line.points.empty())
      return;
    std::string rows;
    for (const auto& [x, y] : line.points)
      fmt::format_to(std::back_inserter(rows), "{:.5g} {:.5g}\n", x, y);
    data += fmt::format("$data{} << EOD\n{}EOD\n", n, rows);
    const std::string title = key.entry(line.goes_with.empty() ? line.label : "");
    plots += n ? ", \\\n" : "plot ";
    if (line.kind == ChartLine::Kind::marks)
      plots += fmt::format("$data{} using 1:2 with points pt {} ps 0.8 lw 1.4 lc rgb '{}' {}", n, line.mark,
                           line.colour, title);
    else
      plots += fmt::format("$data{} using 1:2 with lines lw {} dt {} lc rgb '{}' {}", n, line.width, line.dashes,
                           line.colour, title);
    ++n;
    chart.lines.push_back(std::move(line));
  }

  std::string script(const std::string& set_up) const
  {
    return data + frame(chart.x_label, chart.y_label) + set_up + plots + "\n";
  }

  std::string json() const { return chart.json(); }
  bool empty() const { return n == 0; }
  const ColumnKey& columns() const { return key; }

private:
  Chart chart;
  ColumnKey key;
  std::string data;
  std::string plots;
  int n = 0;
};
} // namespace feldspar::plot

#include "report/pictures/curves/curve_plot.h"

#include "report/pictures/plot_style.h"

#include <fmt/format.h>

#include <algorithm>
#include <iterator>
#include <utility>

namespace feldspar
{
namespace
{
using namespace plot;
}

void CurvePlot::add(const std::size_t layer, ChartLine line)
{
  if (line.points.empty())
    return;
  std::string rows;
  for (const auto& [x, y] : line.points)
    fmt::format_to(std::back_inserter(rows), "{:.5g} {:.5g}\n", x, y);
  const std::string block = fmt::format("$data{}", n_blocks++);
  data += fmt::format("{} << EOD\n{}EOD\n", block, rows);
  const std::string axes = line.to_the_right ? "axes x1y2 " : "";
  const std::string key = title(line.goes_with.empty() ? line.label : "");
  if (line.kind == Kind::area)
    layers[layer].push_back(
      fmt::format("{} using 1:2 {}with filledcurves closed fill solid 0.18 noborder lc rgb '{}' {}", block, axes,
                  line.colour, key));
  else if (line.kind == Kind::steps)
    layers[layer].push_back(fmt::format("{} using 1:2 {}with histeps lw {} dt {} lc rgb '{}' {}", block, axes,
                                        line.width, line.dashes, line.colour, key));
  else
    layers[layer].push_back(fmt::format("{} using 1:2 {}with lines lw {} dt {} lc rgb '{}{}' {}", block, axes,
                                        line.width, line.dashes, line.goes_with.empty() ? "#" : "#90",
                                        line.colour.substr(1), key));
  if (line.goes_with.empty())
    {
      ++n_keys;
      longest_key = std::max(longest_key, int(line.label.size()));
    }
  of_page[layer].push_back(std::move(line));
}

void CurvePlot::add(Mean mean, const bool has_band)
{
  if (has_band)
    {
      Points around = std::move(mean.above);
      around.insert(around.end(), mean.below.rbegin(), mean.below.rend());
      add(0, {.kind = Kind::area,
              .label = mean.label + ", ± standard deviation",
              .goes_with = mean.label,
              .colour = mean.colour,
              .points = std::move(around)});
    }
  add(2, {.label = mean.label, .colour = mean.colour, .dashes = mean.dashes, .points = std::move(mean.points)});
}

std::string CurvePlot::script(const Chart& axes, const std::string& set_up) const
{
  std::string text = data + frame(axes.x_label, axes.y_label) + set_up + "plot ";
  bool first = true;
  for (const auto& layer : layers)
    for (const auto& entry : layer)
      {
        text += (first ? "" : ", \\\n") + entry;
        first = false;
      }
  return text + "\n";
}

std::string CurvePlot::json(Chart axes) const
{
  for (const auto& layer : of_page)
    axes.lines.insert(axes.lines.end(), layer.begin(), layer.end());
  return axes.json();
}

bool CurvePlot::empty() const
{
  return std::all_of(layers.begin(), layers.end(), [](const auto& layer) { return layer.empty(); });
}

int CurvePlot::height(const int columns) const
{
  constexpr int plain_height = 450;
  constexpr int characters = 72; // in a line of the key
  constexpr int mark = 6;        // before each label, in characters
  constexpr int line = 23;       // [px]
  const int fitting = std::clamp(characters / (longest_key + mark), 1, columns);
  return plain_height + line * std::max(0, (n_keys + fitting - 1) / fitting - 2);
}
} // namespace feldspar

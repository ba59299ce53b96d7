#include "report/pictures/calibration_pictures.h"

#include "base/mapped.h"
#include "base/prefixes.h"
#include "report/pictures/figures.h"
#include "report/pictures/plot_style.h"
#include "results/test_quantity.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <string_view>
#include <utility>

namespace feldspar
{
using namespace plot;

namespace
{
constexpr std::size_t most_columns = 7;
constexpr std::size_t most_points = 600; // of a pair; more only blacken the paper

struct SampledColumn
{
  std::string label;
  std::vector<double> values; ///< in the unit of the label
};

/// `bond_cohesion_Pa` as `bond cohesion [MPa]`.
SampledColumn column_of(const std::string& name, const std::vector<double>& si_values)
{
  std::string words = name;
  std::string si_unit = "1";
  for (const std::string_view unit : {"Pa", "rad"})
    if (words.ends_with("_" + std::string(unit)))
      {
        si_unit = unit;
        words.resize(words.size() - unit.size() - 1);
      }
  const ShownUnit unit = shown_unit(si_unit, si_values.front());
  std::ranges::replace(words, '_', ' ');
  return {with_unit(words, unit.name),
          mapped<double>(si_values, [&](const double value) { return value / unit.size; })};
}

/// Step between the marks of an axis, so that one to three stand on it.
double step_of_marks(const std::vector<double>& values)
{
  const auto [least, largest] = std::ranges::minmax_element(values);
  return round_number((*largest - *least) / 1.3);
}

/// Numbers of values in equal parts of the range, as columns of one area.
ChartSeries histogram(const std::vector<double>& values)
{
  constexpr std::size_t n_bins = 24;
  const auto [least, largest] = std::ranges::minmax_element(values);
  const double width = std::max(*largest - *least, 1e-12) / double(n_bins);
  std::vector<std::size_t> counts(n_bins, 0);
  for (const double value : values)
    ++counts[std::min(n_bins - 1, std::size_t((value - *least) / width))];
  ChartSeries columns{.kind = ChartSeries::Kind::area, .colour = blue, .opacity = 0.6, .points = {{*least, 0.0}}};
  for (std::size_t b = 0; b < n_bins; ++b)
    for (const std::size_t side : {b, b + 1})
      columns.points.push_back({*least + double(side) * width, double(counts[b])});
  columns.points.push_back({*largest, 0.0});
  return columns;
}
} // namespace

ShownUnit shown_unit(const std::string& si_unit, const double size)
{
  if (si_unit == "rad")
    return {"deg", std::numbers::pi / 180.0};
  if (si_unit == "Pa")
    return std::abs(size) >= 2.0 * giga ? ShownUnit{"GPa", giga} : ShownUnit{"MPa", mega};
  return {"", 1.0};
}

Pictures pair_picture(const CalibrationRecord& record)
{
  std::vector<SampledColumn> columns;
  for (std::size_t c = 0; c < record.sampled.size() && columns.size() < most_columns; ++c)
    if (const auto& values = record.samples[c];
        !values.empty() && *std::ranges::max_element(values) > *std::ranges::min_element(values))
      columns.push_back(column_of(record.sampled[c], values));
  if (columns.size() < 2)
    return {};
  const std::size_t n = columns.size();
  std::vector<Chart> panels;
  for (std::size_t row = 0; row < n; ++row)
    for (std::size_t c = 0; c < n; ++c)
      {
        Chart& chart = panels.emplace_back(Chart{.look = Chart::Look::matrix, .key_columns = 1});
        if (c > row)
          continue;
        chart.x.label = row + 1 == n ? columns[c].label : "";
        chart.y.label = c == 0 && row > 0 ? columns[row].label : "";
        chart.x.step = step_of_marks(columns[c].values);
        if (c == row)
          {
            chart.y.from = 0.0;
            chart.y.bare = true;
            chart.series = {histogram(columns[c].values)};
            continue;
          }
        ChartSeries points{.kind = ChartSeries::Kind::marks, .colour = blue, .width = 1.0, .size = 0.25};
        const std::size_t n_samples = columns[c].values.size();
        for (std::size_t i = 0; i < n_samples; i += std::max<std::size_t>(1, n_samples / most_points))
          points.points.push_back({columns[c].values[i], columns[row].values[i]});
        chart.series = {std::move(points)};
      }
  return {{.name = "calibration_pairs",
           .caption =
             "Micro-parameters that agree with the tests: each pair, and on the diagonal each by itself. A narrow "
             "band across a pair tells of the two together what the tests do not tell of each.",
           .alternative = fmt::format("Samples of {} micro-parameters of the posterior, pair by pair.", n),
           .width = 190 * int(n) + 60,
           .height = 165 * int(n) + 60,
           .raster = true,
           .vector = false,
           .panels = std::move(panels),
           .columns = int(n)}};
}
} // namespace feldspar

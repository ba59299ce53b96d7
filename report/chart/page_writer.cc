#include "report/chart/page_writer.h"

#include <boost/algorithm/string/replace.hpp>
#include <boost/archive/iterators/base64_from_binary.hpp>
#include <boost/archive/iterators/transform_width.hpp>
#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <utility>

namespace feldspar::live
{
namespace
{
using Json = nlohmann::ordered_json;
using Kind = ChartSeries::Kind;
using Bars = ChartSeries::Bars;

bool is_drawn(const ChartSeries& series)
{
  return series.colours == ChartSeries::Colours::one && series.kind <= Kind::area;
}

/// A line of the page: marks, and bars as pairs of points with a gap after each, are lines of their own.
Json line(const ChartSeries& series, const char* const kind, const std::string& goes_with,
          const std::vector<ChartPoint>& points)
{
  Json rows = Json::array();
  for (const ChartPoint& point : points)
    rows.push_back(std::isfinite(point[0]) && std::isfinite(point[1]) ? Json{number(point[0]), number(point[1])}
                                                                      : Json());
  return {{"kind", kind},          {"label", series.label},   {"goes_with", goes_with}, {"colour", series.colour},
          {"width", series.width}, {"dashes", series.dashes}, {"mark", series.mark},    {"right", series.to_the_right},
          {"points", rows}};
}

void add_lines(Json& lines, const ChartSeries& series)
{
  const std::string& leader = series.goes_with.empty() ? series.label : series.goes_with;
  if (series.kind != Kind::marks)
    lines.push_back(line(series,
                         series.kind == Kind::steps  ? "steps"
                         : series.kind == Kind::area ? "area"
                                                     : "line",
                         series.goes_with, series.points));
  if (series.kind == Kind::marks || series.kind == Kind::marked_line)
    lines.push_back(line(series, "marks", series.kind == Kind::marks ? series.goes_with : leader, series.points));
  std::vector<ChartPoint> bars;
  for (const auto& [x, y, low, high] : series.points)
    if (series.bars != Bars::none && low < high)
      for (const double end : {low, high, gap[0]})
        bars.push_back(series.bars == Bars::along_x ? ChartPoint{end, y} : ChartPoint{x, end});
  if (!bars.empty())
    lines.push_back(line(series, "bars", leader, bars));
}
} // namespace

std::string chart_data(const Chart& chart)
{
  if (chart.empty() || !std::ranges::all_of(chart.series, is_drawn))
    return "";
  const auto& [from_x, to_x] = std::pair(chart.x.from, chart.x.to);
  const auto& [from_y, to_y] = std::pair(chart.y.from, chart.y.to);
  Json data{{"what", "chart"},
            {"x", chart.x.label},
            {"y", chart.y.label},
            {"right", chart.right.label},
            {"from_zero", from_y == 0.0},
            {"logarithmic", std::string(chart.x.logarithmic ? "x" : "") + (chart.y.logarithmic ? "y" : "")},
            {"equal", chart.equal_scales}};
  if (from_x && to_x && from_y && to_y)
    data["part"] = {number(*from_x), number(*to_x), number(*from_y), number(*to_y)};
  data["lines"] = Json::array();
  for (const ChartSeries& series : chart.series)
    if (!series.points.empty())
      add_lines(data["lines"], series);
  return text(data);
}

std::string text(const Json& data)
{
  return boost::replace_all_copy(data.dump(-1, ' ', false, Json::error_handler_t::replace), "<", "\\u003c");
}

std::string base64(const std::string& bytes)
{
  using namespace boost::archive::iterators;
  using Encoder = base64_from_binary<transform_width<std::string::const_iterator, 6, 8>>;
  std::string text(Encoder(bytes.begin()), Encoder(bytes.end()));
  text.append((3 - bytes.size() % 3) % 3, '=');
  return text;
}

Json number(const double value, const int digits)
{
  if (!std::isfinite(value))
    return Json();
  const std::string decimal = fmt::format("{:.{}g}", value, digits);
  double rounded = value; // stays where the decimal lies beyond the range of numbers; std::stod throws below 2e-308 too
  std::from_chars(decimal.data(), decimal.data() + decimal.size(), rounded);
  return Json(rounded);
}
} // namespace feldspar::live

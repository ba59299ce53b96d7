#include "report/live/chart.h"

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <cmath>

namespace feldspar
{
namespace live
{
std::string text(const std::string& words)
{
  std::string quoted = nlohmann::json(words).dump(-1, ' ', false, nlohmann::json::error_handler_t::replace);
  for (std::size_t at = 0; (at = quoted.find('<', at)) != std::string::npos;)
    quoted.replace(at, 1, "\\u003c");
  return quoted;
}

std::string number(const double value, const int digits)
{
  return std::isfinite(value) ? fmt::format("{:.{}g}", value, digits) : "null";
}
} // namespace live

namespace
{
std::string name(const ChartLine::Kind kind)
{
  switch (kind)
    {
    case ChartLine::Kind::steps:
      return "steps";
    case ChartLine::Kind::area:
      return "area";
    case ChartLine::Kind::marks:
      return "marks";
    case ChartLine::Kind::bars:
      return "bars";
    default:
      return "line";
    }
}

std::string json_of(const ChartLine& line)
{
  std::string result =
    fmt::format(R"({{"kind":"{}","label":{},"goes_with":{},"colour":{},"width":{},"dashes":{},"mark":{},)"
                R"("right":{},"points":[)",
                name(line.kind), live::text(line.label), live::text(line.goes_with), live::text(line.colour),
                live::number(line.width), line.dashes, line.mark, line.to_the_right);
  for (const auto& [x, y] : line.points)
    result +=
      std::isfinite(x) && std::isfinite(y) ? fmt::format("[{},{}],", live::number(x), live::number(y)) : "null,";
  if (result.back() == ',')
    result.pop_back();
  return result + "]}";
}
} // namespace

std::string Chart::json() const
{
  std::string result =
    fmt::format(R"({{"what":"chart","x":{},"y":{},"right":{},"from_zero":{},"equal":{},)", live::text(x_label),
                live::text(y_label), live::text(right_label), from_zero, equal_scales);
  if (part)
    result += fmt::format(R"("part":[{},{},{},{}],)", live::number((*part)[0]), live::number((*part)[1]),
                          live::number((*part)[2]), live::number((*part)[3]));
  result += "\"lines\":[";
  for (const auto& line : lines)
    result += json_of(line) + ",";
  if (result.back() == ',')
    result.pop_back();
  return result + "]}";
}
} // namespace feldspar

#include "base/json_text.h"

#include "base/input_error.h"
#include "base/quoted.h"

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <set>
#include <string_view>
#include <vector>

namespace feldspar
{
namespace
{
using Json = nlohmann::ordered_json;

/// The part of nlohmann's message behind its own heading and position.
std::string syntax_error(const std::string& file, const std::string& text, const Json::parse_error& error)
{
  const std::string before = text.substr(0, error.byte == 0 ? 0 : error.byte - 1);
  const auto line = 1 + std::count(before.begin(), before.end(), '\n');
  const std::size_t column = before.size() - (before.rfind('\n') + 1) + 1;
  const std::string message = error.what();
  const std::size_t colon = message.find(": ");
  return fmt::format("{}:{}:{}: is not valid JSON: {}", file, line, column,
                     excerpt(std::string_view(message).substr(colon == std::string::npos ? 0 : colon + 2), 200));
}
} // namespace

nlohmann::ordered_json parse_json(const std::string& file, const std::string& text)
{
  std::vector<std::set<std::string>> names;
  std::vector<std::string> path;
  const auto watch = [&](int, const Json::parse_event_t event, Json& parsed) {
    if (event == Json::parse_event_t::object_start)
      {
        names.emplace_back();
        path.emplace_back();
      }
    else if (event == Json::parse_event_t::key)
      {
        path.back() = parsed.get<std::string>();
        if (!names.back().insert(path.back()).second)
          throw InputError(
            fmt::format("{}: {}: is given twice", file, excerpt(fmt::format("{}", fmt::join(path, "/")))));
      }
    else if (event == Json::parse_event_t::object_end)
      {
        names.pop_back();
        path.pop_back();
      }
    return true;
  };
  try
    {
      return Json::parse(text, watch);
    }
  catch (const Json::parse_error& error)
    {
      throw InputError(syntax_error(file, text, error));
    }
  catch (const Json::out_of_range&)
    {
      throw InputError(fmt::format("{}: a number is beyond the range of numbers", file));
    }
}
} // namespace feldspar

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

// Far beyond what people and this program write. Objects keep their order and look for a name one by one, so that the time
// of a large one grows with the square of its names.
constexpr int most_levels = 100;
constexpr std::size_t most_names = 20000; // of an object

/// The part of nlohmann's message behind its own heading and position.
std::string syntax_error(const std::string& file, const std::string& text, const Json::parse_error& error)
{
  const std::string before = text.substr(0, error.byte == 0 ? 0 : error.byte - 1);
  const auto line = 1 + std::ranges::count(before, '\n');
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
  const auto watch = [&](const int level, const Json::parse_event_t event, Json& parsed) {
    if (level >= most_levels)
      throw InputError("{}: is nested more than {} levels deep", file, most_levels);
    if (event == Json::parse_event_t::object_start)
      {
        names.emplace_back();
        path.emplace_back();
      }
    else if (event == Json::parse_event_t::key)
      {
        path.back() = parsed.get<std::string>();
        if (!names.back().insert(path.back()).second)
          throw InputError("{}: {}: is given twice", file, excerpt(fmt::format("{}", fmt::join(path, "/"))));
        if (names.back().size() > most_names)
          throw InputError("{}: an object has more than {} names", file, most_names);
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
      throw InputError("{}: a number is beyond the range of numbers", file);
    }
}
} // namespace feldspar

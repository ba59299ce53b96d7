#include "app/input/given_entries.h"

#include "base/quoted.h"
#include "base/text.h"

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <optional>
#include <set>

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

/// Parses, and refuses names given twice, of which the parser would keep the last.
Json parse_json(const std::string& file, const std::string& text)
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

/// A value as it would stand in a .prm file, or nothing if it cannot.
std::optional<std::string> prm_text(const Json& value)
{
  if (value.is_string())
    return std::string(trim(value.get_ref<const std::string&>()));
  if (value.is_number())
    return value.dump();
  if (value.is_null())
    return "none";
  if (!value.is_array())
    return std::nullopt;
  std::vector<std::string> items;
  for (const Json& item : value)
    {
      if (!item.is_string() && !item.is_number())
        return std::nullopt;
      items.push_back(*prm_text(item));
    }
  return fmt::format("{}", fmt::join(items, ", "));
}

} // namespace

std::vector<GivenEntry> scan_json(const std::string& file, const std::string& text)
{
  const Json json = parse_json(file, text);
  if (!json.is_object())
    throw InputError(fmt::format(R"({}: the file must be one object, {{"Section": {{"Entry": "value"}}}})", file));
  std::vector<GivenEntry> given;
  for (const auto& [section, entries] : json.items())
    {
      check_section(section, file);
      if (!entries.is_object())
        throw InputError(fmt::format(R"({}: {}: must be an object of entries, {{"Entry": "value"}})", file, section));
      for (const auto& [entry, value] : entries.items())
        {
          check_name({section, entry, "", file});
          const std::optional<std::string> value_text = prm_text(value);
          if (!value_text)
            throw InputError(fmt::format("{}: {}/{}: found {}; must be a string, a number, a list of them or null",
                                         file, section, entry, value.type_name()));
          given.push_back({section, entry, *value_text, file});
        }
    }
  return given;
}
} // namespace feldspar

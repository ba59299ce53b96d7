#include "app/input/given_entries.h"

#include "base/json_text.h"
#include "base/text.h"

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <optional>

namespace feldspar
{
namespace
{
using Json = nlohmann::ordered_json;

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
    throw InputError(R"({}: the file must be one object, {{"Section": {{"Entry": "value"}}}})", file);
  std::vector<GivenEntry> given;
  for (const auto& [section, entries] : json.items())
    {
      check_section(section, file);
      if (!entries.is_object())
        throw InputError(R"({}: {}: must be an object of entries, {{"Entry": "value"}})", file, section);
      for (const auto& [entry, value] : entries.items())
        {
          const std::string name = section + "/" + entry;
          check_name({name, "", file});
          const std::optional<std::string> value_text = prm_text(value);
          if (!value_text)
            throw InputError("{}: {}: found {}; must be a string, a number, a list of them or null", file, name,
                             value.type_name());
          given.push_back({name, *value_text, file});
        }
    }
  return given;
}
} // namespace feldspar

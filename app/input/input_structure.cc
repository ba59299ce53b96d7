#include "app/input/input_structure.h"

#include "app/input/nearest_name.h"
#include "app/input/parameter_table.h"
#include "app/input/quantity.h"
#include "base/input_error.h"

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <optional>
#include <set>
#include <sstream>

namespace feldspar
{
namespace
{
void check_section(const std::string& section, const std::string& place)
{
  const std::vector<std::string_view> sections = section_names();
  if (std::find(sections.begin(), sections.end(), section) == sections.end())
    throw InputError(fmt::format("{}: {}: no such section{}", place, section, suggestion(section, sections)));
}

/// What follows the keyword, in the two spellings deal.II knows.
std::optional<std::string> after(const std::string_view small, const std::string_view capital,
                                 const std::string_view line)
{
  if (!line.starts_with(small) && !line.starts_with(capital))
    return std::nullopt;
  return std::string(trim(line.substr(small.size())));
}

/// Reads the lines of a .prm file as deal.II 9.4 does (ParameterHandler::parse_input, scan_line).
class PrmScanner
{
public:
  explicit PrmScanner(const std::string& file_name)
    : file(file_name)
  {
  }

  void scan_line(const std::size_t number, std::string line)
  {
    line.erase(std::min(line.find('#'), line.size()));
    std::replace(line.begin(), line.end(), '\t', ' ');
    const std::string_view words = trim(line);
    const std::string place = fmt::format("{}:{}", file, number);

    if (words.empty())
      return;
    if (const auto name = after("subsection ", "SUBSECTION ", words))
      open_section(*name, place, number);
    else if (after("end", "END", words))
      close_section(words, place);
    else if (const auto setting = after("set ", "SET ", words))
      add_entry(*setting, place);
    else if (after("include ", "INCLUDE ", words))
      throw InputError(fmt::format("{}: include: is not available; write the entries into this file", place));
    else
      throw InputError(fmt::format(
        "{}: \"{}\": is not understood; a line is \"subsection NAME\", \"set NAME = VALUE\", \"end\" or a comment (#)",
        place, words));
  }

  std::vector<GivenEntry> finish() const
  {
    if (!section.empty())
      throw InputError(fmt::format("{}:{}: subsection {}: is not closed; write \"end\" after its last entry", file,
                                   section_line, section));
    return entries;
  }

private:
  void open_section(const std::string& name, const std::string& place, const std::size_t number)
  {
    if (!section.empty())
      throw InputError(fmt::format("{}: subsection {}: opens inside {} of line {}, which is not closed; write \"end\"",
                                   place, name, section, section_line));
    check_section(name, place);
    section = name;
    section_line = number;
  }

  void close_section(const std::string_view words, const std::string& place)
  {
    if (words.size() > 3)
      throw InputError(fmt::format("{}: \"{}\": is not understood; \"end\" stands alone on its line", place, words));
    if (section.empty())
      throw InputError(fmt::format("{}: end: there is no open subsection", place));
    section.clear();
  }

  void add_entry(const std::string& setting, const std::string& place)
  {
    const std::size_t equals = setting.find('=');
    if (equals == std::string::npos)
      throw InputError(fmt::format("{}: \"set {}\": has no value; write \"set NAME = VALUE\"", place, setting));
    const std::string entry(trim(std::string_view(setting).substr(0, equals)));
    if (section.empty())
      throw InputError(fmt::format("{}: {}: stands outside of any subsection", place, entry));
    const GivenEntry given{section, entry, place};
    check_name(given);
    for (const GivenEntry& earlier : entries)
      if (earlier.section == section && earlier.entry == entry)
        throw InputError(fmt::format("{}: {}/{}: is given twice, first in {}", place, section, entry, earlier.place));
    entries.push_back(given);
  }

  const std::string file;
  std::string section;
  std::size_t section_line = 0;
  std::vector<GivenEntry> entries;
};

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
                     message.substr(colon == std::string::npos ? 0 : colon + 2));
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
          throw InputError(fmt::format("{}: {}: is given twice", file, fmt::join(path, "/")));
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

void check_name(const GivenEntry& given)
{
  if (!find_parameter(given.section, given.entry))
    throw InputError(fmt::format("{}: {}/{}: no such entry{}", given.place, given.section, given.entry,
                                 suggestion(given.entry, entry_names(given.section))));
}

std::vector<GivenEntry> scan_prm(const std::string& file, const std::string& text)
{
  PrmScanner scanner(file);
  std::istringstream stream(text);
  std::string joined;
  std::size_t number = 0;
  std::size_t first_number = 1;
  for (std::string line; std::getline(stream, line);)
    {
      ++number;
      if (joined.empty())
        first_number = number;
      line = trim(line);
      const bool continues = line.ends_with('\\');
      joined += line.substr(0, line.size() - continues);
      if (continues)
        continue;
      scanner.scan_line(first_number, joined);
      joined.clear();
    }
  scanner.scan_line(first_number, joined);
  return scanner.finish();
}

JsonInput scan_json(const std::string& file, const std::string& text)
{
  const Json json = parse_json(file, text);
  if (!json.is_object())
    throw InputError(fmt::format(R"({}: the file must be one object, {{"Section": {{"Entry": "value"}}}})", file));
  JsonInput input;
  Json normal = Json::object();
  for (const auto& [section, entries] : json.items())
    {
      check_section(section, file);
      if (!entries.is_object())
        throw InputError(fmt::format(R"({}: {}: must be an object of entries, {{"Entry": "value"}})", file, section));
      for (const auto& [entry, value] : entries.items())
        {
          const GivenEntry given{section, entry, file};
          check_name(given);
          const std::optional<std::string> value_text = prm_text(value);
          if (!value_text)
            throw InputError(fmt::format("{}: {}/{}: found {}; must be a string, a number, a list of them or null",
                                         file, section, entry, value.type_name()));
          input.entries.push_back(given);
          normal[section][entry] = *value_text;
        }
    }
  input.normal_text = normal.dump();
  return input;
}
} // namespace feldspar

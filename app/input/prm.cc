#include "app/input/given_entries.h"

#include "base/quoted.h"
#include "base/text.h"

#include <fmt/format.h>

#include <algorithm>
#include <optional>
#include <sstream>

namespace feldspar
{
namespace
{
/// The rest of the line after a keyword in one of its two spellings.
std::optional<std::string> after(const std::string_view small, const std::string_view capital,
                                 const std::string_view line)
{
  if (!line.starts_with(small) && !line.starts_with(capital))
    return std::nullopt;
  return std::string(trim(line.substr(small.size())));
}
} // namespace

GivenEntry entry_of(const std::string& section, const std::string& setting, const std::string& place)
{
  const std::size_t equals = setting.find('=');
  if (equals == std::string::npos)
    throw InputError("{}: {}: has no value; write \"set NAME = VALUE\"", place, in_quotes("set " + setting));
  const std::string_view all = setting, entry = trim(all.substr(0, equals));
  if (section.empty())
    throw InputError("{}: {}: stands outside of any subsection", place, excerpt(entry));
  GivenEntry given{fmt::format("{}/{}", section, entry), std::string(trim(all.substr(equals + 1))), place};
  check_name(given);
  return given;
}

// The format of deal.II's ParameterHandler, whose duplicates and unclosed subsections are mistakes here.
std::vector<GivenEntry> scan_prm(const std::string& file, const std::string& text)
{
  std::vector<GivenEntry> entries;
  std::string section;
  std::size_t section_line = 0;
  const auto scan_line = [&](const std::size_t number, std::string line) {
    line.erase(std::min(line.find('#'), line.size()));
    std::ranges::replace(line, '\t', ' ');
    const std::string_view words = trim(line);
    const std::string place = fmt::format("{}:{}", file, number);
    const auto refuse = [&](const std::string& found, const std::string& why) {
      throw InputError("{}: {}: {}", place, found, why);
    };
    if (words.empty())
      return;
    if (const auto name = after("subsection ", "SUBSECTION ", words))
      {
        if (!section.empty())
          refuse("subsection " + excerpt(*name),
                 fmt::format("opens inside {} of line {}, which is not closed; write \"end\"", section, section_line));
        check_section(*name, place);
        section = *name;
        section_line = number;
      }
    else if (after("end", "END", words))
      {
        if (words.size() > 3)
          refuse(in_quotes(words), "is not understood; \"end\" stands alone on its line");
        if (section.empty())
          refuse("end", "there is no open subsection");
        section.clear();
      }
    else if (const auto setting = after("set ", "SET ", words))
      {
        const GivenEntry given = entry_of(section, *setting, place);
        if (const auto earlier = std::ranges::find(entries, given.name, &GivenEntry::name); earlier != entries.end())
          refuse(given.name, "is given twice, first in " + earlier->place);
        entries.push_back(given);
      }
    else if (after("include ", "INCLUDE ", words))
      refuse("include", "is not available; write the entries into this file");
    else
      refuse(in_quotes(words), "is not understood; a line is \"subsection NAME\", \"set NAME = VALUE\", \"end\" or a "
                               "comment (#)");
  };
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
      scan_line(first_number, joined);
      joined.clear();
    }
  scan_line(first_number, joined);
  if (!section.empty())
    throw InputError("{}:{}: subsection {}: is not closed; write \"end\" after its last entry", file, section_line,
                     section);
  return entries;
}
} // namespace feldspar

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

/// Reads the lines of a .prm file: the format of deal.II's ParameterHandler, whose duplicates and unclosed subsections are
/// mistakes here.
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
        "{}: {}: is not understood; a line is \"subsection NAME\", \"set NAME = VALUE\", \"end\" or a comment (#)",
        place, in_quotes(words)));
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
                                   place, excerpt(name), section, section_line));
    check_section(name, place);
    section = name;
    section_line = number;
  }

  void close_section(const std::string_view words, const std::string& place)
  {
    if (words.size() > 3)
      throw InputError(
        fmt::format("{}: {}: is not understood; \"end\" stands alone on its line", place, in_quotes(words)));
    if (section.empty())
      throw InputError(fmt::format("{}: end: there is no open subsection", place));
    section.clear();
  }

  void add_entry(const std::string& setting, const std::string& place)
  {
    const std::size_t equals = setting.find('=');
    if (equals == std::string::npos)
      throw InputError(
        fmt::format("{}: {}: has no value; write \"set NAME = VALUE\"", place, in_quotes("set " + setting)));
    const std::string entry(trim(std::string_view(setting).substr(0, equals)));
    if (section.empty())
      throw InputError(fmt::format("{}: {}: stands outside of any subsection", place, excerpt(entry)));
    const GivenEntry given{section, entry, std::string(trim(std::string_view(setting).substr(equals + 1))), place};
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

} // namespace

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
} // namespace feldspar

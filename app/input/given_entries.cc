#include "app/input/given_entries.h"

#include "app/input/nearest_name.h"
#include "app/input/parameter_table.h"
#include "base/contains.h"
#include "base/quoted.h"
#include "base/readable_file.h"
#include "base/text.h"

#include <nlohmann/json.hpp>

#include <algorithm>
#include <iterator>
#include <system_error>

namespace feldspar
{
namespace
{
/// A file of lines in UTF-8, without the mark some editors put before the first.
std::string read_text(const std::filesystem::path& file)
{
  ReadableFile stream(file);
  std::error_code ignored;
  constexpr std::uintmax_t largest = 16 << 20;
  if (const std::uintmax_t size = std::filesystem::file_size(file, ignored); !ignored && size > largest)
    throw InputError("{}: has {} bytes; an input file has at most {}", file.string(), size, largest);
  std::string text(std::istreambuf_iterator<char>(stream), {});
  if (text.starts_with("\xEF\xBB\xBF"))
    text.erase(0, 3);

  const auto is_binary = [](const unsigned char c) { return c < 0x20 && (c < '\t' || c > '\r'); };
  if (std::ranges::any_of(text, is_binary))
    throw InputError("{}: is not a text file", file.string());
  try
    {
      static_cast<void>(nlohmann::json(text).dump()); // which checks the encoding
    }
  catch (const nlohmann::json::type_error&)
    {
      throw InputError("{}: is not encoded in UTF-8", file.string());
    }
  return text;
}

/// Section/Entry = value, of the command line.
GivenEntry setting_of(const std::string& text)
{
  const std::size_t slash = text.find('/');
  if (const std::size_t equals = text.find('='); equals == std::string::npos || slash > equals)
    throw InputError("--set {}: write \"Section/Entry = value\", e.g. \"Specimen/Width = 30 mm\"", in_quotes(text));
  const std::string section(trim(std::string_view(text).substr(0, slash)));
  check_section(section, "--set");
  return entry_of(section, text.substr(slash + 1), "--set");
}

} // namespace

void check_section(const std::string& section, const std::string& place)
{
  const std::vector<std::string_view> sections = section_names();
  if (!contains(sections, section))
    throw InputError("{}: {}: no such section{}", place, excerpt(section), suggestion(section, sections));
}

void check_name(const GivenEntry& given)
{
  if (find_parameter(given.name))
    return;
  const std::string section = given.name.substr(0, given.name.find('/'));
  const std::string entry = given.name.substr(section.size() + 1);
  throw InputError("{}: {}/{}: no such entry{}", given.place, section, excerpt(entry),
                   suggestion(entry, entry_names(section)));
}

GivenEntries::GivenEntries(const std::filesystem::path& path, const std::vector<std::string>& settings)
  : file(path.string())
{
  const std::string text = read_text(path);
  if (path.extension() == ".prm")
    entries = scan_prm(file, text);
  else if (path.extension() == ".json")
    entries = scan_json(file, text);
  else
    throw InputError("{}: the name must end in .prm or .json", file);

  for (const std::string& setting : settings)
    {
      const GivenEntry given = setting_of(setting);
      const auto same = std::ranges::find(entries, given.name, &GivenEntry::name);
      if (same == entries.end())
        entries.push_back(given);
      else if (same->place == given.place)
        throw InputError("--set: {}: is given twice", given.name);
      else
        *same = given;
    }
}

std::string GivenEntries::value(const std::string_view entry) const
{
  const GivenEntry* const given = valid(entry);
  return given ? given->value : find_parameter(entry)->default_text();
}

GivenEntries GivenEntries::with(const std::vector<VariantSetting>& settings, const std::string_view entry) const
{
  GivenEntries changed = *this;
  const GivenEntry* const source = find(entries, entry);
  for (const VariantSetting& setting : settings)
    changed.of_variant.push_back({setting.entry, setting.value, source ? source->place : file});
  return changed;
}

InputError GivenEntries::error(const std::string_view entry, const std::string_view text) const
{
  const GivenEntry* const given = valid(entry);
  return InputError("{}: {} = {}: {}", given ? given->place : file, entry, excerpt(value(entry)), text);
}

const GivenEntry* GivenEntries::find(const std::vector<GivenEntry>& among, const std::string_view entry)
{
  const auto found = std::ranges::find(among, entry, &GivenEntry::name);
  return found == among.end() ? nullptr : &*found;
}

const GivenEntry* GivenEntries::valid(const std::string_view entry) const
{
  const GivenEntry* const varied = find(of_variant, entry);
  return varied ? varied : find(entries, entry);
}
} // namespace feldspar

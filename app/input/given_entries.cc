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
  const std::size_t equals = text.find('=');
  const std::size_t slash = text.find('/');
  if (equals == std::string::npos || slash > equals)
    throw InputError("--set {}: write \"Section/Entry = value\", e.g. \"Specimen/Width = 30 mm\"", in_quotes(text));
  const std::string_view all = text;
  GivenEntry given{std::string(trim(all.substr(0, slash))),
                   std::string(trim(all.substr(slash + 1, equals - slash - 1))),
                   std::string(trim(all.substr(equals + 1))), "--set"};
  check_section(given.section, given.place);
  check_name(given);
  return given;
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
  if (!find_parameter(given.section, given.entry))
    throw InputError("{}: {}/{}: no such entry{}", given.place, given.section, excerpt(given.entry),
                     suggestion(given.entry, entry_names(given.section)));
}

GivenEntries::GivenEntries(const std::filesystem::path& file, const std::vector<std::string>& settings)
  : name(file.string())
{
  const std::string text = read_text(file);
  if (file.extension() == ".prm")
    entries = scan_prm(name, text);
  else if (file.extension() == ".json")
    entries = scan_json(name, text);
  else
    throw InputError("{}: the name must end in .prm or .json", name);

  for (const std::string& setting : settings)
    {
      const GivenEntry given = setting_of(setting);
      const auto same = std::ranges::find_if(
        entries, [&](const GivenEntry& one) { return one.section == given.section && one.entry == given.entry; });
      if (same == entries.end())
        entries.push_back(given);
      else if (same->place == given.place)
        throw InputError("--set: {}/{}: is given twice", given.section, given.entry);
      else
        *same = given;
    }
}

std::string GivenEntries::value(const std::string_view section, const std::string_view entry) const
{
  const GivenEntry* const given = valid(section, entry);
  return given ? given->value : find_parameter(section, entry)->default_text();
}

GivenEntries GivenEntries::with(const std::vector<VariantSetting>& settings, const std::string_view section,
                                const std::string_view entry) const
{
  GivenEntries changed = *this;
  const GivenEntry* const source = find(entries, section, entry);
  for (const VariantSetting& setting : settings)
    {
      const std::size_t slash = setting.entry.find('/');
      changed.of_variant.push_back({setting.entry.substr(0, slash), setting.entry.substr(slash + 1), setting.value,
                                    source ? source->place : name});
    }
  return changed;
}

InputError GivenEntries::error(const std::string_view section, const std::string_view entry,
                               const std::string_view text) const
{
  const GivenEntry* const given = valid(section, entry);
  return InputError("{}: {}/{} = {}: {}", given ? given->place : name, section, entry, excerpt(value(section, entry)),
                    text);
}

const GivenEntry* GivenEntries::find(const std::vector<GivenEntry>& among, const std::string_view section,
                                     const std::string_view entry)
{
  const auto found = std::ranges::find_if(
    among, [&](const GivenEntry& candidate) { return candidate.section == section && candidate.entry == entry; });
  return found == among.end() ? nullptr : &*found;
}

const GivenEntry* GivenEntries::valid(const std::string_view section, const std::string_view entry) const
{
  const GivenEntry* const varied = find(of_variant, section, entry);
  return varied ? varied : find(entries, section, entry);
}
} // namespace feldspar

#pragma once

#include "base/input_error.h"
#include "results/variant_setting.h"

#include <filesystem>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

/// The entries that an input file gives, in one reading: their names checked, their values still text.
namespace feldspar
{
/// An entry that the file gives.
struct GivenEntry
{
  std::string name;  ///< Section/Entry
  std::string value; ///< as it would stand in a .prm file, trimmed
  std::string place; ///< `file:line`, or `file` where the format keeps no lines
};

/// Lines of `subsection NAME`, `set NAME = VALUE`, `end`, comments from # on, a backslash at the end continues a line.
/// Throws InputError.
std::vector<GivenEntry> scan_prm(const std::string& file, const std::string& text);

/// {"Section": {"Entry": value, …}, …}; a value is a string, a number, an array of them (a list), or null (none).
/// Throws InputError.
std::vector<GivenEntry> scan_json(const std::string& file, const std::string& text);

/// The entry of a section that "NAME = VALUE" sets. Throws InputError.
GivenEntry entry_of(const std::string& section, const std::string& setting, const std::string& place);

/// Throws InputError unless there is a section of that name.
void check_section(const std::string& section, const std::string& place);

/// Throws InputError unless the section has the entry.
void check_name(const GivenEntry& given);

/// All entries of a file, found by their names.
class GivenEntries
{
public:
  /// Reads a .prm or .json file. `settings`: Section/Entry = value each, in place of what the file says. Throws
  /// InputError.
  explicit GivenEntries(const std::filesystem::path& path, const std::vector<std::string>& settings = {});

  /// Entries that do not come from a file, each with its place.
  explicit GivenEntries(std::vector<GivenEntry> given)
    : file("input")
    , entries(std::move(given))
  {
  }

  const std::vector<GivenEntry>& all() const { return entries; }

  /// Returns whether the file gives an entry, whatever a variant sets.
  bool has(std::string_view entry) const { return find(entries, entry) != nullptr; }

  /// Value of the variant, else as given, or else the default.
  std::string value(std::string_view entry) const;

  /// The same for the errors of a variant, whose settings are given at the place of an entry.
  GivenEntries with(const std::vector<VariantSetting>& settings, std::string_view entry) const;

  /// An error about an entry: `beishan.prm:12: Flat joint/Bond friction angle = 95 deg: ` and the text.
  InputError error(std::string_view entry, std::string_view text) const;

  /// The same; the text has values.
  template <typename First, typename... More>
  InputError error(const std::string_view entry, fmt::format_string<First, More...> text, First&& first,
                   More&&... more) const
  {
    return error(entry, std::string_view(fmt::format(text, std::forward<First>(first), std::forward<More>(more)...)));
  }

private:
  /// The entry as the variant sets it, or else as it is given; none where it is neither.
  const GivenEntry* valid(std::string_view entry) const;

  static const GivenEntry* find(const std::vector<GivenEntry>& among, std::string_view entry);

  std::string file;
  std::vector<GivenEntry> entries;
  std::vector<GivenEntry> of_variant;
};
} // namespace feldspar

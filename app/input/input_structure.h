#pragma once

#include <string>
#include <string_view>
#include <vector>

/// The structure of an input file, without its values: which entries it gives and where. deal.II's ParameterHandler,
/// which reads the values, lets duplicates and unclosed subsections pass and tells errors in paragraphs.
namespace feldspar
{
/// An entry that the file gives.
struct GivenEntry
{
  std::string section;
  std::string entry;
  std::string place; ///< `file:line`, or `file` where the format keeps no lines
};

/// Lines of `subsection NAME`, `set NAME = VALUE`, `end`, comments from # on, a backslash at the end continues a line.
std::vector<GivenEntry> scan_prm(const std::string& file, const std::string& text);

/// A JSON file, its values turned to the text they would have in a .prm file.
struct JsonInput
{
  std::vector<GivenEntry> entries;
  std::string normal_text; ///< the same input in the form deal.II reads: every value a string
};

/// {"Section": {"Entry": value, …}, …}; a value is a string, a number, an array of them (a list), or null (none).
JsonInput scan_json(const std::string& file, const std::string& text);

/// Throws InputError unless the section has the entry.
void check_name(const GivenEntry& given);
} // namespace feldspar

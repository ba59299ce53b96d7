#include "app/commands/commands.h"
#include "app/input/nearest_name.h"
#include "app/input/parameter_table.h"
#include "app/screen/print_result.h"
#include "base/input_error.h"
#include "base/quoted.h"
#include "base/text.h"

#include <fmt/format.h>

#include <optional>
#include <vector>

/// `feldspar parameters`: the reference, made from the table that reading and checking use.
namespace feldspar
{
namespace
{
std::string or_dash(const std::string& text) { return text.empty() ? "-" : text; }

void print_entry(const std::string& heading, const Parameter& parameter)
{
  print_result(
    "{}", for_terminal(fmt::format("{}\n    unit {}; default {}; range {}\n    {}\n", heading, or_dash(parameter.unit),
                                   parameter.default_text(), parameter.range, parameter.described())));
}

using Entries = std::vector<const Parameter*>;

void print_plain(const std::string_view section, const Entries& entries)
{
  print_result("{}\n", section);
  for (const Parameter* const parameter : entries)
    print_entry(fmt::format("  {}", parameter->entry), *parameter);
}

void print_markdown(const std::string_view section, const Entries& entries)
{
  print_result("\n### {}\n\n| entry | unit | default | range | meaning |\n|---|---|---|---|---|\n", section);
  for (const Parameter* const parameter : entries)
    print_result("| {} | {} | {} | {} | {} |\n", parameter->entry, or_dash(parameter->unit), parameter->default_text(),
                 parameter->range, parameter->described());
}

/// The entries of all sections, or of one, that are basic or not; without `basic` both.
void print_sections(const std::string& only, const std::optional<bool> basic, const bool markdown)
{
  for (const std::string_view section : section_names())
    if (only.empty() || only == section)
      {
        Entries entries;
        for (const Parameter& parameter : parameter_table())
          if (parameter.section == section && parameter.flags.basic == basic.value_or(parameter.flags.basic))
            entries.push_back(&parameter);
        if (!entries.empty())
          markdown ? print_markdown(section, entries) : print_plain(section, entries);
      }
}

/// The entries that have a word in their name, meaning or choices, capital or small; throws InputError where none has.
void print_found(const std::string& word)
{
  const std::string wanted = in_small_letters(word);
  bool found = false;
  for (const Parameter& parameter : parameter_table())
    if (in_small_letters(fmt::format("{} {} {}", parameter.name(), parameter.described(), parameter.range))
          .find(wanted) != std::string::npos)
      {
        print_entry(parameter.name(), parameter);
        found = true;
      }
  if (!found)
    throw InputError("{}: no such section, and no entry has it in its name, meaning or choices{}", excerpt(word),
                     suggestion(word, section_names()));
}
} // namespace

int run_parameters(const ParametersOptions& options)
{
  if (options.check)
    check_input(*options.check, options.settings, options.check_for);
  else if (options.results)
    print_results_reference();
  else if (!options.section.empty() && entry_names(options.section).empty())
    print_found(options.section);
  else if (!options.section.empty())
    print_sections(options.section, std::nullopt, options.markdown);
  else
    {
      print_result("{}", options.markdown ? "# Parameters\n\nWritten by `feldspar parameters --markdown`.\n\n"
                                            "## Entries of a first study\n"
                                          : "ENTRIES OF A FIRST STUDY\n");
      print_sections("", true, options.markdown);
      print_result("{}", options.markdown ? "\n## Further entries\n" : "FURTHER ENTRIES\n");
      print_sections("", false, options.markdown);
    }
  return 0;
}
} // namespace feldspar

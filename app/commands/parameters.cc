#include "app/commands/commands.h"
#include "app/input/input.h"
#include "app/input/nearest_name.h"
#include "app/input/parameter_table.h"
#include "base/input_error.h"

#include <fmt/format.h>

/// `feldspar parameters`: the reference, made from the table that reading and checking use.
namespace feldspar
{
namespace
{
std::string or_dash(const std::string& text) { return text.empty() ? "-" : text; }

void print_plain(const std::string_view section)
{
  fmt::print("{}\n", section);
  for (const Parameter& parameter : parameter_table())
    if (parameter.section == section)
      fmt::print("  {}\n    unit {}; default {}; range {}\n    {}\n", parameter.entry, or_dash(parameter.unit),
                 parameter.default_text(), parameter.range, parameter.meaning);
}

void print_markdown(const std::string_view section)
{
  fmt::print("\n## {}\n\n| entry | unit | default | range | meaning |\n|---|---|---|---|---|\n", section);
  for (const Parameter& parameter : parameter_table())
    if (parameter.section == section)
      fmt::print("| {} | {} | {} | {} | {} |\n", parameter.entry, or_dash(parameter.unit), parameter.default_text(),
                 parameter.range, parameter.meaning);
}

void check_section(const std::string& section)
{
  if (entry_names(section).empty())
    throw InputError(fmt::format("{}: no such section{}", section, suggestion(section, section_names())));
}
} // namespace

int run_parameters(const ParametersOptions& options)
{
  if (options.check)
    {
      read_input(*options.check);
      fmt::print("{}: OK\n", options.check->string());
      return 0;
    }
  if (!options.section.empty())
    check_section(options.section);
  if (options.markdown)
    fmt::print("# Parameters\n\nWritten by `feldspar parameters --markdown`.\n");
  for (const std::string_view section : section_names())
    if (options.section.empty() || options.section == section)
      options.markdown ? print_markdown(section) : print_plain(section);
  return 0;
}
} // namespace feldspar

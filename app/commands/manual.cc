#include "app/commands/manual.h"

#include "app/input/parameter_table.h"
#include "base/text.h"
#include "feldspar_version.h"

#include <fmt/format.h>

#include <sstream>
#include <string_view>
#include <vector>

namespace feldspar
{
namespace
{
std::vector<const CLI::App*> commands_of(const CLI::App& command_line)
{
  return command_line.get_subcommands([](const CLI::App*) { return true; });
}

/// Escapes text for roff: a backslash is an order there, a hyphen may become a dash, and a line that begins with a dot
/// or a quote is a request.
std::string in_roff(const std::string_view text)
{
  std::string safe;
  bool begins_line = true;
  for (const char c : text)
    {
      if (begins_line && (c == '.' || c == '\''))
        safe += "\\&";
      if (c == '\\')
        safe += "\\e";
      else if (c == '-')
        safe += "\\-";
      else
        safe += c;
      begins_line = c == '\n';
    }
  return safe;
}

/// Option as it is typed: --output DIR.
std::string usage(const CLI::Option& option)
{
  std::string text = option.get_name();
  if (!option.get_positional() && option.get_items_expected_max() > 0 && !option.get_type_name().empty())
    text += fmt::format(" {}", option.get_type_name());
  return text;
}

std::string roff_of_options(const CLI::App& command)
{
  std::string text;
  for (const CLI::Option* const option : command.get_options())
    text += fmt::format(".TP\n\\fB{}\\fR\n{}\n", in_roff(usage(*option)), in_roff(option->get_description()));
  return text;
}

/// A line of CLI11's help, whose description begins in this column; others stay as they are.
std::string folded(const std::string& line, const std::size_t column)
{
  constexpr std::size_t page = 80;
  const bool is_description =
    line.size() > column && line.starts_with("  ") && line[column - 1] == ' ' && line[column] != ' ';
  if (width_of(line) <= page || !is_description)
    return line;
  const std::string indent(column, ' ');
  std::string text;
  for (const std::string& words : in_lines(line.substr(column), page - column))
    text += (text.empty() ? line.substr(0, column) : "\n" + indent) + words;
  return text;
}
} // namespace

std::string help_on(const CLI::App& command, const std::string& name)
{
  const auto formatter = command.get_formatter();
  std::istringstream lines(formatter->make_help(&command, name, CLI::AppFormatMode::Normal));
  std::string text;
  for (std::string line; std::getline(lines, line);)
    text += folded(line, formatter->get_column_width()) + "\n";
  return text;
}

std::string manual_page(const CLI::App& command_line)
{
  std::string text = fmt::format(
    ".TH FELDSPAR 1 \"\" \"feldspar {}\" \"User Commands\"\n"
    ".SH NAME\nfeldspar \\- {}\n"
    ".SH SYNOPSIS\n\\fBfeldspar\\fR \\fICOMMAND\\fR [\\fIARGUMENTS\\fR]\n"
    ".SH DESCRIPTION\n"
    "Feldspar computes how brittle rock deforms, cracks and fails, from its grains and bonds up to the laboratory "
    "sample. An input file states what differs from the defaults, each quantity with its unit. A run writes one folder "
    "with its curves, cracks, pictures and report.\n"
    ".SH COMMANDS\n",
    in_roff(version), in_roff("laboratory tests on rock made of grains and bonds"));
  for (const CLI::App* const command : commands_of(command_line))
    {
      text += fmt::format(".SS {}\n{}.\n{}", in_roff(command->get_name()), in_roff(command->get_description()),
                          roff_of_options(*command));
      if (!command->get_footer().empty())
        text += fmt::format(".PP\n.EX\n{}\n.EE\n", in_roff(command->get_footer()));
    }
  text += ".SH PARAMETERS\nThe entries of an input file, by section.\n";
  for (const std::string_view section : section_names())
    {
      text += fmt::format(".SS {}\n", in_roff(section));
      for (const Parameter& parameter : parameter_table())
        if (parameter.section == section)
          text += fmt::format(".TP\n\\fB{}\\fR\n{}.\nDefault {}{}; range {}.\n", in_roff(parameter.entry),
                              in_roff(parameter.described()), in_roff(parameter.default_text()),
                              parameter.unit.empty() ? "" : fmt::format("; in {}", in_roff(parameter.unit)),
                              in_roff(parameter.range));
    }
  text +=
    ".SH EXIT STATUS\n"
    ".TP\n\\fB0\\fR\nsuccess\n"
    ".TP\n\\fB2\\fR\nthe input or the command line is wrong; one line on standard error says what is allowed\n"
    ".TP\n\\fB3\\fR\na file cannot be written\n"
    ".TP\n\\fB4\\fR\na calibration missed a target; its last line says which\n"
    ".TP\n\\fB5\\fR\nthe packings of a calibration do not decide whether it reached its targets; its last line says "
    "how many would\n"
    ".TP\n\\fB130\\fR\ninterrupted; the last line says how to go on\n"
    ".TP\n\\fBothers\\fR\na fault of the program; the last lines say how to reproduce it\n";
  return text;
}

std::string bash_completion(const CLI::App& command_line)
{
  std::string names;
  std::string options;
  for (const CLI::App* const command : commands_of(command_line))
    {
      names += fmt::format(" {}", command->get_name());
      std::string of_command;
      for (const CLI::Option* const option : command->get_options())
        for (const std::string& name : option->get_lnames())
          of_command += fmt::format(" --{}", name);
      options += fmt::format("    {}) words='{}' ;;\n", command->get_name(), of_command.substr(1));
    }
  std::string sections;
  for (const std::string_view section : section_names())
    sections += fmt::format("{}\n", section);
  std::string entries;
  for (const Parameter& parameter : parameter_table())
    entries += fmt::format("{}\n", parameter.name());
  return fmt::format(R"bash(# Completion of feldspar {} for bash; written by `feldspar completion`.
# Offers the names on standard input that begin as the word does, in quotes of the kind that the word has or with backslashes.
_feldspar_names()
{{
  local word=$1 end=$2 quote= name
  [[ $word == [\"\']* ]] && quote=${{word:0:1}} word=${{word:1}}
  word=${{word//\\/}}
  while read -r name; do
    [[ $name == "$word"* ]] || continue
    name+=$end
    [[ $quote ]] || printf -v name '%q' "$name"
    COMPREPLY+=("$name")
  done
}}
_feldspar()
{{
  local word=${{COMP_WORDS[COMP_CWORD]}} before=${{COMP_WORDS[COMP_CWORD-1]}} command=${{COMP_WORDS[1]}} words=
  COMPREPLY=()
  if ((COMP_CWORD == 1)) || {{ ((COMP_CWORD == 2)) && [[ $command == help ]]; }}; then
    COMPREPLY=($(compgen -W '{} --help --version' -- "$word"))
    return
  fi
  case $command in
{}  esac
  if [[ $word == -* ]]; then
    COMPREPLY=($(compgen -W "$words" -- "$word"))
  elif [[ $before == --set ]]; then
    compopt -o nospace 2>/dev/null
    _feldspar_names "$word" ' = ' <<'entries'
{}entries
  elif [[ $command == parameters ]] && ((COMP_CWORD == 2)); then
    _feldspar_names "$word" '' <<'sections'
{}sections
  fi
}}
complete -o default -F _feldspar feldspar
)bash",
                     version, names.substr(1), options, entries, sections);
}
} // namespace feldspar

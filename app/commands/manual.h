#pragma once

#include <CLI/App.hpp>

#include <string>

/// The command line told to a reader and to other programs: man and bash. All texts are made from the description that reads
/// the command line, and from the table of parameters.
namespace feldspar
{
/// The help on a command, which `name` calls as it is typed, in lines of 80 characters where words allow it.
std::string help_on(const CLI::App& command, const std::string& name);

/// The manual page, for man (roff).
std::string manual_page(const CLI::App& command_line);

/// A completion script for bash: commands, their options, and sections of `feldspar parameters`.
std::string bash_completion(const CLI::App& command_line);
} // namespace feldspar

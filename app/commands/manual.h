#pragma once

#include <CLI/App.hpp>

#include <string>

/// The command line told to other programs: man and bash. Both texts are made from the description that reads the command
/// line, and from the table of parameters.
namespace feldspar
{
/// The manual page, for man (roff).
std::string manual_page(const CLI::App& command_line);

/// A completion script for bash: commands, their options, and sections of `feldspar parameters`.
std::string bash_completion(const CLI::App& command_line);
} // namespace feldspar

#pragma once

#include <cstddef>
#include <string>
#include <string_view>

/// Text of others (input files, names of folders, results from elsewhere) as messages and pages may show it.
namespace feldspar
{
/// One line of UTF-8: control characters as \n or \x1b, bytes that are not UTF-8 and the codes U+FFFE and U+FFFF, which
/// XML forbids, as \xff. Everything else stays.
std::string printable(std::string_view text);

/// printable(), cut to a number of characters; the last of these is then an ellipsis.
std::string excerpt(std::string_view text, std::size_t most_characters = 72);

/// printable(), cut in its middle to a number of characters: a message begins with the place and ends with the advice.
std::string shortened(std::string_view text, std::size_t most_characters);

/// An excerpt between double quotation marks, as messages repeat an entry or a cell.
std::string in_quotes(std::string_view text);

/// Returns whether text may name a file, a part of a script or a table without any quoting: at most 235 letters,
/// digits, `.`, `_`, `-` and `+` of ASCII, a letter or a digit first.
bool is_plain_name(std::string_view text);
} // namespace feldspar

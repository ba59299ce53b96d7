#pragma once

#include <fmt/format.h>

#include <cstddef>
#include <string>
#include <string_view>
#include <utility>

namespace feldspar
{
/// Writes results to standard output, control characters in them as \x1b, and never throws. A reader that has left, as
/// `| head` does, is no mistake and hears no more; of a full disk the command speaks at its end, when its files are complete.
void write_result(std::string_view text);

/// Text of several lines as a terminal may get it: printable() but for line ends and tabs.
std::string printable_lines(std::string_view text);

/// Lines of at most so many characters (some tens), broken at spaces and gone on with two spaces more than they begin with.
/// Rows of tables, which have three spaces or more within, and words that are longer stay as they are.
std::string wrapped(std::string_view text, std::size_t width);

/// The text as results show it: wrapped on a terminal, as it stands elsewhere.
std::string for_terminal(std::string_view text);

template <typename... T>
void print_result(fmt::format_string<T...> format, T&&... values)
{
  write_result(fmt::format(format, std::forward<T>(values)...));
}
} // namespace feldspar

#pragma once

#include <fmt/format.h>

#include <string_view>
#include <utility>

namespace feldspar
{
/// Writes results to standard output, and never throws. A reader that has left, as `| head` does, is no mistake and hears
/// no more; of a full disk the command speaks at its end, when its files are complete.
void write_result(std::string_view text);

template <typename... T>
void print_result(fmt::format_string<T...> format, T&&... values)
{
  write_result(fmt::format(format, std::forward<T>(values)...));
}
} // namespace feldspar

#include "base/text.h"

#include "base/input_error.h"
#include "base/quoted.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <sstream>
#include <system_error>

namespace feldspar
{
std::string_view trim(const std::string_view text)
{
  constexpr std::string_view white = " \t\r\n\v\f";
  const std::size_t first = text.find_first_not_of(white);
  if (first == std::string_view::npos)
    return {};
  return text.substr(first, text.find_last_not_of(white) + 1 - first);
}

std::string in_small_letters(const std::string_view text)
{
  std::string small(text);
  for (char& c : small)
    c = c >= 'A' && c <= 'Z' ? char(c - 'A' + 'a') : c;
  return small;
}

std::size_t width_of(const std::string_view text)
{
  return std::size_t(std::ranges::count_if(text, [](const char c) { return (c & 0xC0) != 0x80; }));
}

std::vector<std::string> in_lines(const std::string_view words, const std::size_t most, const std::string_view indent)
{
  std::vector<std::string> lines{""};
  std::istringstream in{std::string(words)};
  for (std::string word; in >> word;)
    {
      std::string& line = lines.back();
      if (!line.empty() && width_of(line) + 1 + width_of(word) > most)
        lines.push_back(std::string(indent) + word);
      else
        line += (line.empty() ? "" : " ") + word;
    }
  return lines;
}

std::string duration_in_words(const double seconds)
{
  return seconds < 90.0     ? fmt::format("{:.0f} s", std::max(1.0, seconds))
         : seconds < 7200.0 ? fmt::format("{:.0f} min", seconds / 60.0)
                            : fmt::format("{:.0f} h", seconds / 3600.0);
}

std::string some_of(const std::vector<std::string>& names)
{
  constexpr std::size_t most = 5;
  const auto n = std::min(most, names.size());
  return fmt::format("{}{}", fmt::join(names.begin(), names.begin() + std::ptrdiff_t(n), ", "),
                     names.size() > n ? fmt::format(" and {} more", names.size() - n) : "");
}

std::vector<std::string_view> split_at(const std::string_view separator, std::string_view text)
{
  std::vector<std::string_view> pieces;
  for (;;)
    {
      const std::size_t end = text.find(separator);
      pieces.push_back(trim(text.substr(0, end)));
      if (end == std::string_view::npos)
        return pieces;
      text.remove_prefix(end + separator.size());
    }
}

std::vector<std::string_view> split_at_commas(const std::string_view text) { return split_at(",", text); }

bool is_decimal_number(std::string_view text)
{
  const auto skip_one_of = [&](const std::string_view characters) {
    const bool found = !text.empty() && characters.find(text.front()) != std::string_view::npos;
    text.remove_prefix(found);
    return found;
  };
  const auto skip_digits = [&] {
    const std::size_t n = std::min(text.find_first_not_of("0123456789"), text.size());
    text.remove_prefix(n);
    return n;
  };

  skip_one_of("+-");
  std::size_t n_digits = skip_digits();
  if (skip_one_of("."))
    n_digits += skip_digits();
  if (n_digits == 0)
    return false;
  if (skip_one_of("eE"))
    {
      skip_one_of("+-");
      if (skip_digits() == 0)
        return false;
    }
  return text.empty();
}

double parse_number(const std::string_view text)
{
  if (!is_decimal_number(text))
    throw InputError(text.empty() ? "a number is missing" : fmt::format("{} is not a decimal number", in_quotes(text)));
  double value = 0.0;
  const std::string_view unsigned_text = text.substr(text.starts_with('+')); // from_chars knows no plus
  const auto end = unsigned_text.data() + unsigned_text.size();
  if (std::from_chars(unsigned_text.data(), end, value).ec == std::errc::result_out_of_range)
    throw InputError("{} is beyond the range of numbers", in_quotes(text));
  return value;
}
} // namespace feldspar

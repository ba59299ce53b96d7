#pragma once

#include <charconv>
#include <cstddef>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

/// Text as people and tables write it: white space, commas, decimal numbers.
namespace feldspar
{
/// Returns the text without the white space at both ends.
std::string_view trim(std::string_view text);

/// Returns the text with the letters of ASCII small; those of other alphabets stay.
std::string in_small_letters(std::string_view text);

/// Characters of UTF-8, which is the width on a terminal but for combining and double ones.
std::size_t width_of(std::string_view text);

/// Words in lines of at most so many characters, as far as the words allow it; all but the first begin with `indent`.
std::vector<std::string> in_lines(std::string_view words, std::size_t most, std::string_view indent = "");

/// About how long something takes: "40 s", "12 min", "3 h".
std::string duration_in_words(double seconds);

/// The first five names of a list, separated by commas, and how many more there are.
std::string some_of(const std::vector<std::string>& names);

/// The pieces between separators, trimmed; one at least.
std::vector<std::string_view> split_at(std::string_view separator, std::string_view text);

/// The pieces between commas, trimmed; one at least.
std::vector<std::string_view> split_at_commas(std::string_view text);

/// Returns whether all of the text is [sign] digits [. digits] [e [sign] digits].
bool is_decimal_number(std::string_view text);

/// The number that the text is as a whole, as std::from_chars() reads it; none for any other text.
template <typename T>
std::optional<T> number_in(const std::string_view text)
{
  T value{};
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  return error == std::errc() && end == text.data() + text.size() ? std::optional(value) : std::nullopt;
}

/// One decimal number; `nan` and `inf` are none. The decimal sign is a point in every locale. Throws InputError.
double parse_number(std::string_view text);
} // namespace feldspar

#include "base/quoted.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cstdint>
#include <vector>

namespace feldspar
{
namespace
{
/// Bytes of the UTF-8 character that `text` begins with (RFC 3629, section 4); 0 if it begins with none.
std::size_t length_of_character(const std::string_view text)
{
  const auto byte = [&](const std::size_t k) { return k < text.size() ? std::uint8_t(text[k]) : std::uint8_t(0); };
  const auto continues = [&](const std::size_t k) { return (byte(k) & 0xc0u) == 0x80u; };
  const std::uint8_t first = byte(0);
  if (first < 0x80)
    return 1;
  const std::size_t n = first < 0xc2 ? 0 : first < 0xe0 ? 2 : first < 0xf0 ? 3 : first < 0xf5 ? 4 : 0;
  for (std::size_t k = 1; k < n; ++k)
    if (!continues(k))
      return 0;
  const bool overlong = (first == 0xe0 && byte(1) < 0xa0) || (first == 0xf0 && byte(1) < 0x90);
  const bool surrogate = first == 0xed && byte(1) > 0x9f;
  const bool no_character = first == 0xef && byte(1) == 0xbf && byte(2) >= 0xbe; // U+FFFE, U+FFFF
  const bool beyond_unicode = first == 0xf4 && byte(1) > 0x8f;
  return overlong || surrogate || no_character || beyond_unicode ? 0 : n;
}

bool is_control(const std::string_view character)
{
  const auto first = std::uint8_t(character[0]);
  const bool in_ascii = first < 0x20 || first == 0x7f;
  const bool beyond_ascii = first == 0xc2 && std::uint8_t(character[1]) < 0xa0; // U+0080 to U+009F
  return in_ascii || beyond_ascii;
}

std::string escaped(const std::string_view bytes)
{
  if (bytes == "\n")
    return "\\n";
  if (bytes == "\r")
    return "\\r";
  if (bytes == "\t")
    return "\\t";
  std::string text;
  for (const char byte : bytes)
    text += fmt::format("\\x{:02x}", std::uint8_t(byte));
  return text;
}

/// Takes the next character off `text`, as it is shown.
std::string take_character(std::string_view& text)
{
  const std::size_t length = length_of_character(text);
  const std::string_view character = text.substr(0, std::max<std::size_t>(length, 1));
  text.remove_prefix(character.size());
  return length == 0 || is_control(character) ? escaped(character) : std::string(character);
}
} // namespace

std::string printable(std::string_view text)
{
  std::string result;
  while (!text.empty())
    result += take_character(text);
  return result;
}

std::string excerpt(std::string_view text, const std::size_t most_characters)
{
  std::string result;
  std::string shorter; // with room for the ellipsis
  std::size_t n = 0;
  while (!text.empty())
    {
      const std::string shown = take_character(text);
      n += shown.front() == '\\' ? shown.size() : 1; // an escape is of ASCII alone
      if (n > most_characters)
        return shorter + "…";
      result += shown;
      if (n < most_characters)
        shorter = result;
    }
  return result;
}

std::string shortened(std::string_view text, const std::size_t most_characters)
{
  std::vector<std::string> characters;
  while (!text.empty())
    characters.push_back(take_character(text));
  if (characters.size() <= most_characters)
    return fmt::format("{}", fmt::join(characters, ""));
  const auto n_first = std::ptrdiff_t(3 * most_characters / 4), n_last = std::ptrdiff_t(most_characters) - n_first - 1;
  return fmt::format("{}…{}", fmt::join(characters.begin(), characters.begin() + n_first, ""),
                     fmt::join(characters.end() - n_last, characters.end(), ""));
}

std::string in_quotes(const std::string_view text) { return '"' + excerpt(text) + '"'; }

bool is_plain_name(const std::string_view text)
{
  constexpr std::size_t most_characters = 235; // of 255 in a file's name, with room for endings
  const auto is_letter_or_digit = [](const char c) {
    return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9');
  };
  return !text.empty() && text.size() <= most_characters && is_letter_or_digit(text.front()) &&
         std::ranges::all_of(
           text, [&](const char c) { return is_letter_or_digit(c) || c == '.' || c == '_' || c == '-' || c == '+'; });
}
} // namespace feldspar

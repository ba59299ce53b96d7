#pragma once

#include <fmt/format.h>

#include <charconv>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

/// Colours as files write them: #rrggbb of 0xRRGGBB.
namespace feldspar
{
inline std::string colour_text(const std::uint32_t colour) { return fmt::format("#{:06x}", colour); }

/// Returns none of a text that is no colour.
inline std::optional<std::uint32_t> parse_colour(const std::string_view text)
{
  constexpr int hexadecimal = 16;
  const char* const end = text.data() + text.size();
  std::uint32_t colour = 0;
  if (text.size() != 7 || text[0] != '#' || std::from_chars(text.data() + 1, end, colour, hexadecimal).ptr != end)
    return std::nullopt;
  return colour;
}
} // namespace feldspar

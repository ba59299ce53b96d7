#pragma once

#include <array>
#include <cstdint>

namespace feldspar
{
/// Of a mineral grain or clump by its number, and of grains without one, 0: 0xRRGGBB. Pale, so that cracks stand out.
/// Neighbours in number are seldom neighbours in place.
constexpr unsigned int group_colour(const std::uint32_t group)
{
  constexpr std::array tones{0xead9b8u, 0xc3d6e6u, 0xd9c7deu, 0xcfe2c3u, 0xe9c9c0u, 0xe3e3d0u, 0xbfd8d2u};
  return group == 0 ? 0xd8d8d8u : tones[group % tones.size()];
}
} // namespace feldspar

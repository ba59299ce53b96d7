#include "report/pictures/maps/group_colour.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <map>
#include <set>

namespace feldspar
{
namespace
{
constexpr std::array group_tones{0xead9b8u, 0xc3d6e6u, 0xd9c7deu, 0xcfe2c3u, 0xe9c9c0u, 0xe3e3d0u, 0xbfd8d2u};
constexpr unsigned int tone_of_none = 0xd8d8d8;
constexpr double touching = 1.1; ///< of two radii: grains within it are in contact, or are joined across their gap

using GridBox = std::array<double, 3>;

/// The groups beside each group.
std::map<std::uint32_t, std::set<std::uint32_t>> neighbours_of(const std::vector<GrainPicture>& grains)
{
  std::map<std::uint32_t, std::set<std::uint32_t>> neighbours;
  double side = 0.0;
  for (const GrainPicture& grain : grains)
    side = std::max(side, 2.0 * touching * grain.radius);
  std::map<GridBox, std::vector<const GrainPicture*>> boxes;
  for (const GrainPicture& grain : grains)
    {
      const auto& [x, y, z] = grain.start;
      if (grain.group == 0 || !(std::isfinite(x) && std::isfinite(y) && std::isfinite(z) && side > 0.0))
        continue;
      neighbours[grain.group];
      const GridBox box{std::floor(x / side), std::floor(y / side), std::floor(z / side)};
      for (int k = 0; k < 27; ++k)
        if (const auto found = boxes.find({box[0] + k % 3 - 1, box[1] + k / 3 % 3 - 1, box[2] + k / 9 - 1});
            found != boxes.end())
          for (const GrainPicture* const other : found->second)
            if (other->group != grain.group &&
                std::hypot(other->start[0] - x, other->start[1] - y, other->start[2] - z) <
                  touching * (other->radius + grain.radius))
              {
                neighbours[grain.group].insert(other->group);
                neighbours[other->group].insert(grain.group);
              }
      boxes[box].push_back(&grain);
    }
  return neighbours;
}
} // namespace

std::vector<unsigned int> group_colours(const std::vector<GrainPicture>& grains)
{
  // Groups in the order of number take the first tone that fewest of their neighbours have.
  std::map<std::uint32_t, std::size_t> tone;
  for (const auto& [group, beside] : neighbours_of(grains))
    {
      std::array<std::size_t, group_tones.size()> n_beside{};
      for (const std::uint32_t other : beside)
        if (const auto known = tone.find(other); known != tone.end())
          ++n_beside[known->second];
      tone[group] = std::size_t(std::ranges::min_element(n_beside) - n_beside.begin());
    }
  std::vector<unsigned int> colours;
  for (const GrainPicture& grain : grains)
    {
      const auto found = tone.find(grain.group);
      colours.push_back(found == tone.end() ? tone_of_none : group_tones[found->second]);
    }
  return colours;
}
} // namespace feldspar

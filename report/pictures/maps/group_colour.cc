#include "report/pictures/maps/group_colour.h"

#include "base/mapped.h"
#include "report/pictures/maps/near_grains.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <map>
#include <set>

namespace feldspar
{
std::vector<unsigned int> group_colours(const std::vector<GrainPicture>& grains)
{
  constexpr std::array group_tones{0xead9b8u, 0xc3d6e6u, 0xd9c7deu, 0xcfe2c3u, 0xe9c9c0u, 0xe3e3d0u, 0xbfd8d2u};
  constexpr unsigned int tone_of_none = 0xd8d8d8;
  const NearGrains near(grains);
  std::map<std::uint32_t, std::set<std::uint32_t>> beside; // the groups beside each group
  for (const GrainPicture& grain : grains)
    if (const auto& [x, y, z] = grain.start;
        grain.group != 0 && std::isfinite(x) && std::isfinite(y) && std::isfinite(z))
      {
        auto& others = beside[grain.group];
        near.visit_near(grain.start, [&](const GrainPicture& other) {
          if (other.group != 0 && other.group != grain.group &&
              std::hypot(other.start[0] - grain.start[0], other.start[1] - grain.start[1],
                         other.start[2] - grain.start[2]) < NearGrains::touching * (other.radius + grain.radius))
            others.insert(other.group);
        });
      }
  // Groups in the order of number take the first tone that fewest of their neighbours have.
  std::map<std::uint32_t, std::size_t> tone;
  for (const auto& [group, others] : beside)
    {
      std::array<std::size_t, group_tones.size()> n_beside{};
      for (const std::uint32_t other : others)
        if (const auto known = tone.find(other); known != tone.end())
          ++n_beside[known->second];
      tone[group] = std::size_t(std::ranges::min_element(n_beside) - n_beside.begin());
    }
  return mapped<unsigned int>(grains, [&](const GrainPicture& grain) {
    const auto found = tone.find(grain.group);
    return found == tone.end() ? tone_of_none : group_tones[found->second];
  });
}
} // namespace feldspar

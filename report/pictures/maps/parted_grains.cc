#include "report/pictures/maps/parted_grains.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace feldspar
{
PartedGrains::PartedGrains(const std::vector<GrainPicture>& all_grains)
  : grains(all_grains)
{
  for (const GrainPicture& grain : grains)
    side = std::max(side, 2.2 * grain.radius); // a crack lies in the gap between two surfaces
  for (std::size_t i = 0; i < grains.size(); ++i)
    boxes[key_of(box_of(grains[i].start))].push_back(i);
}

std::array<const GrainPicture*, 2> PartedGrains::of(const Crack& crack) const
{
  std::array<const GrainPicture*, 2> nearest{};
  std::array<double, 2> least{std::numeric_limits<double>::infinity(), std::numeric_limits<double>::infinity()};
  const auto middle = box_of(crack.centroid);
  for (int n = 0; n < 27; ++n)
    {
      const auto found = boxes.find(key_of({middle[0] + n % 3 - 1, middle[1] + n / 3 % 3 - 1, middle[2] + n / 9 - 1}));
      if (found == boxes.end())
        continue;
      for (const std::size_t i : found->second)
        {
          const GrainPicture& grain = grains[i];
          const double distance = std::hypot(grain.start[0] - crack.centroid[0], grain.start[1] - crack.centroid[1],
                                             grain.start[2] - crack.centroid[2]) -
                                  grain.radius;
          if (distance < least[0])
            {
              least = {distance, least[0]};
              nearest = {&grain, nearest[0]};
            }
          else if (distance < least[1])
            {
              least[1] = distance;
              nearest[1] = &grain;
            }
        }
    }
  return nearest;
}

double PartedGrains::opening(const Crack& crack) const
{
  const auto [a, b] = of(crack);
  if (b == nullptr)
    return 0.0;
  double apart = 0.0, along = 0.0;
  for (std::size_t c = 0; c < 3; ++c)
    {
      apart += (b->position[c] - b->start[c] - a->position[c] + a->start[c]) * crack.normal[c];
      along += (b->start[c] - a->start[c]) * crack.normal[c];
    }
  return std::max(0.0, along < 0.0 ? -apart : apart);
}

std::array<std::int64_t, 3> PartedGrains::box_of(const std::array<double, 3>& place) const
{
  std::array<std::int64_t, 3> box{};
  for (std::size_t c = 0; c < 3; ++c)
    box[c] = std::llround(place[c] / side);
  return box;
}

std::uint64_t PartedGrains::key_of(const std::array<std::int64_t, 3>& box)
{
  constexpr std::uint64_t most = 1U << 21U; // boxes along an axis
  return (std::uint64_t(box[0]) % most * most + std::uint64_t(box[1]) % most) * most + std::uint64_t(box[2]) % most;
}
} // namespace feldspar

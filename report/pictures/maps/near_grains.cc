#include "report/pictures/maps/near_grains.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace feldspar
{
NearGrains::NearGrains(const std::vector<GrainPicture>& grains)
{
  for (const GrainPicture& grain : grains)
    side = std::max(side, 2.0 * touching * grain.radius); // a crack lies in the gap between two surfaces
  for (const GrainPicture& grain : grains)
    boxes[key_of(box_of(grain.start))].push_back(&grain);
}

std::array<const GrainPicture*, 2> NearGrains::parted_by(const Crack& crack) const
{
  std::array<const GrainPicture*, 2> nearest{};
  std::array<double, 2> least{std::numeric_limits<double>::infinity(), std::numeric_limits<double>::infinity()};
  visit_near(crack.centroid, [&](const GrainPicture& grain) {
    const double to_surface = std::hypot(grain.start[0] - crack.centroid[0], grain.start[1] - crack.centroid[1],
                                         grain.start[2] - crack.centroid[2]) -
                              grain.radius;
    if (to_surface < least[0])
      {
        least = {to_surface, least[0]};
        nearest = {&grain, nearest[0]};
      }
    else if (to_surface < least[1])
      {
        least[1] = to_surface;
        nearest[1] = &grain;
      }
  });
  return nearest;
}

double NearGrains::opening(const Crack& crack) const
{
  const auto [a, b] = parted_by(crack);
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

std::array<std::int64_t, 3> NearGrains::box_of(const std::array<double, 3>& place) const
{
  return {std::llround(place[0] / side), std::llround(place[1] / side), std::llround(place[2] / side)};
}

std::uint64_t NearGrains::key_of(const std::array<std::int64_t, 3>& box)
{
  constexpr std::uint64_t most = 1U << 21U; // boxes along an axis
  return (std::uint64_t(box[0]) % most * most + std::uint64_t(box[1]) % most) * most + std::uint64_t(box[2]) % most;
}
} // namespace feldspar

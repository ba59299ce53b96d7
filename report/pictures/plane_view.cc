#include "report/pictures/plane_view.h"

#include <algorithm>
#include <cmath>

namespace feldspar
{
FinishedTest plane_view(FinishedTest test)
{
  TestRecord& record = test.record;
  auto& grains = test.appearance.grains_at_end;
  if (record.dimension() == 2)
    return test;
  const double depth = record.size[1];
  const auto outside_slice = [depth](const std::array<double, 3>& point) {
    return std::abs(point[1] - 0.5 * depth) > 0.125 * depth;
  };
  std::erase_if(grains, [&](const GrainPicture& grain) { return outside_slice(grain.position); });
  std::erase_if(record.cracks, [&](const Crack& crack) { return outside_slice(crack.centroid); });
  // The ones in front are drawn last.
  std::sort(grains.begin(), grains.end(),
            [](const GrainPicture& a, const GrainPicture& b) { return a.position[1] > b.position[1]; });
  for (auto& grain : grains)
    grain.position = {grain.position[0], grain.position[2], 0.0};
  for (auto& crack : record.cracks)
    {
      // A small plate seen from the front: the line along which its plane cuts the picture's.
      const double across = std::hypot(crack.normal[0], crack.normal[2]);
      crack.centroid = {crack.centroid[0], crack.centroid[2], 0.0};
      crack.normal = across > 0.0 ? std::array<double, 3>{crack.normal[0] / across, crack.normal[2] / across, 0.0}
                                  : std::array<double, 3>{1.0, 0.0, 0.0};
    }
  for (auto& flaw : test.appearance.flaws)
    for (auto& point : flaw.outline)
      point = {point[0], point[2], 0.0};
  record.size = {record.size[0], record.size[2], 0.0};
  return test;
}
} // namespace feldspar

#pragma once

#include "laboratory/appearance.h"

#include <array>
#include <cstddef>
#include <cstdint>
#include <unordered_map>
#include <vector>

namespace feldspar
{
/// Grains by their places where the loading began, to find those that a crack parts and those that are beside each other.
class NearGrains
{
public:
  /// Distance of two grains in contact, or joined across their gap, at most: over the sum of their radii.
  static constexpr double touching = 1.1;

  /// `grains` must outlive it.
  explicit NearGrains(const std::vector<GrainPicture>& grains);

  /// The two grains whose surfaces were nearest to a crack when the loading began, the nearest first; null where there
  /// are none near.
  std::array<const GrainPicture*, 2> parted_by(const Crack& crack) const;

  /// Distance by which both grains of a crack moved apart across it, from the beginning of the loading to the end of the
  /// test [m]; 0 where they came nearer. The rotation of the grains is not in it.
  double opening(const Crack& crack) const;

  /// Calls `visit` with every grain that may be in contact with a grain, or with the gap, at a place.
  template <typename Visit>
  void visit_near(const std::array<double, 3>& place, const Visit& visit) const
  {
    const auto middle = box_of(place);
    for (int n = 0; n < 27; ++n)
      if (const auto found =
            boxes.find(key_of({middle[0] + n % 3 - 1, middle[1] + n / 3 % 3 - 1, middle[2] + n / 9 - 1}));
          found != boxes.end())
        for (const GrainPicture* const grain : found->second)
          visit(*grain);
  }

private:
  std::array<std::int64_t, 3> box_of(const std::array<double, 3>& place) const;
  static std::uint64_t key_of(const std::array<std::int64_t, 3>& box);

  double side = 0.0; ///< of a box [m]
  std::unordered_map<std::uint64_t, std::vector<const GrainPicture*>> boxes;
};
} // namespace feldspar

#pragma once

#include "laboratory/appearance.h"

#include <array>
#include <cstddef>
#include <cstdint>
#include <unordered_map>
#include <vector>

namespace feldspar
{
/// Grains by their places, to find those that a crack parts.
class PartedGrains
{
public:
  /// `grains` must outlive it.
  explicit PartedGrains(const std::vector<GrainPicture>& grains);

  /// The two grains whose surfaces were nearest to a crack when the loading began, the nearest first; null where there
  /// are none near.
  std::array<const GrainPicture*, 2> of(const Crack& crack) const;

  /// Distance by which both grains of a crack moved apart across it, from the beginning of the loading to the end of the
  /// test [m]; 0 where they came nearer. The rotation of the grains is not in it.
  double opening(const Crack& crack) const;

private:
  std::array<std::int64_t, 3> box_of(const std::array<double, 3>& place) const;
  static std::uint64_t key_of(const std::array<std::int64_t, 3>& box);

  const std::vector<GrainPicture>& grains;
  double side = 0.0; ///< of a box [m]
  std::unordered_map<std::uint64_t, std::vector<std::size_t>> boxes;
};
} // namespace feldspar

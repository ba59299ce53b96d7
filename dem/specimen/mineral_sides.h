#pragma once

#include "dem/specimen/specimen.h"
#include "laboratory/specimen_report.h"

#include <algorithm>
#include <cstdint>
#include <string>
#include <vector>

namespace feldspar
{
/// Minerals on both sides of a joint or crack, by numbers from 1; 0: of a rock without minerals.
struct MineralSides
{
  std::uint32_t lower = 0;
  std::uint32_t higher = 0;
  bool on_boundary = false; ///< between two mineral grains
};

/// Returns the minerals of two grains, numbered as the specimen has them.
template <int dim>
MineralSides mineral_sides(const Specimen<dim>& specimen, const std::uint32_t one, const std::uint32_t two)
{
  if (specimen.mineral.empty())
    return {};
  const auto [lower, higher] = std::minmax({specimen.mineral[one] + 1, specimen.mineral[two] + 1});
  return {lower, higher, specimen.groups[one] != specimen.groups[two]};
}

/// Returns the number, from 1, of the mineral of this name in a list that has it.
inline std::uint32_t number_of_mineral(const std::vector<MineralShare>& minerals, const std::string& name)
{
  const auto found = std::ranges::find(minerals, name, [](const MineralShare& one) { return one.mineral.name; });
  return std::uint32_t(found - minerals.begin()) + 1;
}
} // namespace feldspar

#pragma once

#include "base/vector.h"

#include <cstdint>
#include <string>
#include <vector>

namespace feldspar
{
/// A hole, slot or closed flaw as it lies in a specimen, for pictures, files and whoever loads it.
template <int dim>
struct Flaw
{
  std::string name;                 ///< as the input calls its kind: hole, slot, closed flaw, joint set
  bool open = false;                ///< grains were taken out; of a closed flaw the faces are still in contact
  std::vector<Vector<dim>> outline; ///< points of a line, of a hole closed; in space of its cut through the middle [m]
  std::uint64_t n_grains = 0;       ///< taken out
  std::uint64_t n_joints = 0;       ///< cut, or of a closed flaw unbonded
};
} // namespace feldspar

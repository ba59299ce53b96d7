#pragma once

#include "dem/dynamics/sweeps/joint_sweep.h"
#include "dem/storage/joints.h"

#include <cstddef>
#include <cstdint>
#include <vector>

namespace feldspar
{
/// Groups of neighbouring joints in storage. A sweep computes a pack of joints segment by segment if one of them needs
/// it. Joints with broken bonds are therefore put together, and those without any bond apart from those with some: most
/// joints without bonds are open and need no computation. The order follows from numbers and bonds alone.
template <int dim>
class JointGroups
{
public:
  JointGroups() = default;
  explicit JointGroups(const Joints<dim>& joints);

  /// Records the breaks of a sweep.
  void note(const std::vector<Break>& breaks, const Joints<dim>& joints);

  /// Puts joints together anew where more than a sixteenth of all packs would then have no broken bond any more. Returns
  /// whether it did: joints have other places now.
  bool regroup(Joints<dim>& joints);

private:
  /// Kinds of joints in the order in which they are put.
  enum Bonds : std::uint8_t
  {
    all,
    none,
    some
  };
  /// The joints in the order in which they are to stand.
  std::vector<std::size_t> grouped(const Joints<dim>& joints) const;

  std::vector<Bonds> bonds; ///< of each joint
  bool has_changed = false; ///< since regroup() looked
};
} // namespace feldspar

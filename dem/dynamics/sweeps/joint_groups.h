#pragma once

#include "dem/dynamics/sweeps/joint_sweep.h"
#include "dem/storage/joints.h"

#include <cstddef>
#include <cstdint>
#include <vector>

namespace feldspar
{
/// Which neighbouring joints stand together in storage. A sweep takes a pack of joints the long way, segment by segment, if
/// one of them needs it. Joints with broken bonds are therefore put together, those with no bond left apart from those with
/// some: most of the former stand open and need no look. The order that is made follows from numbers and bonds alone.
template <int dim>
class JointGroups
{
public:
  JointGroups() = default;
  explicit JointGroups(const Joints<dim>& joints);

  /// What broke in a sweep.
  void note(const std::vector<Break>& breaks, const Joints<dim>& joints);

  /// Puts joints together anew where more than a sixteenth of all packs would then have no broken bond any more. Returns
  /// whether it did: joints have other places now.
  bool regroup(Joints<dim>& joints);

private:
  /// In the order in which they are put.
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

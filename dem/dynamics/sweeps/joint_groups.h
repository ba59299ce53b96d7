#pragma once

#include "dem/dynamics/sweeps/joint_sweep.h"
#include "dem/storage/joints.h"

#include <cstdint>
#include <vector>

namespace feldspar
{
/// Which neighbouring joints stand together in storage. A sweep takes a pack of joints the long way, segment by segment, if
/// one of them needs it: joints with broken bonds are therefore gathered. The order that joints have among each other, by
/// which their forces are summed, is that of their numbers.
template <int dim>
class JointGroups
{
public:
  JointGroups() = default;
  explicit JointGroups(const Joints<dim>& joints);

  /// What broke in a sweep.
  void note(const std::vector<Break>& breaks, const Joints<dim>& joints);

  /// Gathers joints anew where this spares more than a sixteenth of all packs the long way. Returns whether it did; then
  /// joints have other places.
  bool gather(Joints<dim>& joints);

private:
  /// In the order in which they are put.
  enum Bonds : std::uint8_t
  {
    all,
    none,
    some
  };
  std::size_t n_spared() const;

  std::vector<Bonds> bonds; ///< of each joint
  bool has_changed = false; ///< since gather() looked
};
} // namespace feldspar

#include "dem/dynamics/sweeps/joint_groups.h"

#include <algorithm>
#include <utility>

namespace feldspar
{
namespace
{
// The width of this processor's packs is not used: the order must be the same on every machine.
constexpr std::size_t pack = 8;
/// Number of joints that follow each other by their numbers, which are those of their places in space. Only these
/// change places among each other, so that their grains and states stay near each other in memory.
constexpr std::size_t window = 256;

/// Packs with a joint of which this is true.
template <typename IsBroken>
std::size_t n_packs(const std::size_t n_joints, IsBroken&& is_broken)
{
  std::size_t n = 0;
  for (std::size_t begin = 0; begin < n_joints; begin += pack)
    {
      bool some_broken = false;
      for (std::size_t k = begin; k < std::min(begin + pack, n_joints); ++k)
        some_broken = some_broken || is_broken(k);
      n += some_broken;
    }
  return n;
}
} // namespace

template <int dim>
JointGroups<dim>::JointGroups(const Joints<dim>& joints)
  : bonds(joints.size())
  , has_changed(true)
{
  for (std::size_t j = 0; j < joints.size(); ++j)
    bonds[j] = joints.holds_wholly(j) ? all : joints.holds(j) ? some : none;
}

template <int dim>
void JointGroups<dim>::note(const std::vector<Break>& breaks, const Joints<dim>& joints)
{
  for (const Break& event : breaks)
    bonds[event.joint] = joints.holds(event.joint) ? some : none;
  has_changed = has_changed || !breaks.empty();
}

template <int dim>
std::vector<std::size_t> JointGroups<dim>::grouped(const Joints<dim>& joints) const
{
  std::vector<std::size_t> order = joints.by_number();
  for (auto begin = order.begin(); begin != order.end();)
    {
      const auto end = begin + std::min(std::ptrdiff_t(window), order.end() - begin);
      std::sort(begin, end, [&](const std::size_t a, const std::size_t b) {
        return std::pair(bonds[a], joints.number[a]) < std::pair(bonds[b], joints.number[b]);
      });
      begin = end;
    }
  return order;
}

template <int dim>
bool JointGroups<dim>::regroup(Joints<dim>& joints)
{
  if (!std::exchange(has_changed, false))
    return false;
  const auto is_broken = [&](const std::size_t j) { return bonds[j] != all; };
  const std::size_t n_now = n_packs(bonds.size(), is_broken);
  const auto spares_enough = [&](const std::size_t n_then) {
    return 16 * pack * n_now > 16 * pack * n_then + bonds.size();
  };
  // No order has fewer than packs full of them: where that is not enough, none needs to be made.
  const auto n_broken =
    std::size_t(std::count_if(bonds.begin(), bonds.end(), [](const Bonds one) { return one != all; }));
  if (!spares_enough((n_broken + pack - 1) / pack))
    return false;
  const std::vector<std::size_t> order = grouped(joints);
  if (!spares_enough(n_packs(bonds.size(), [&](const std::size_t k) { return is_broken(order[k]); })))
    return false;
  joints.reorder(order);
  std::vector<Bonds> moved(bonds.size());
  std::transform(order.begin(), order.end(), moved.begin(), [&](const std::size_t j) { return bonds[j]; });
  bonds = std::move(moved);
  return true;
}

template class JointGroups<2>;
template class JointGroups<3>;
} // namespace feldspar

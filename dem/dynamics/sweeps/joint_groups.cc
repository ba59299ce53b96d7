#include "dem/dynamics/sweeps/joint_groups.h"

#include <algorithm>
#include <numeric>
#include <variant>

namespace feldspar
{
namespace
{
// Not those of this processor's packs: the order is to be the same on every machine.
constexpr std::size_t pack = 8;
/// Joints that change places lie in one of these: their grains and their own numbers stay near each other in memory.
constexpr std::size_t window = 256;
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

/// Packs that would not have a joint with a broken bond.
template <int dim>
std::size_t JointGroups<dim>::n_spared() const
{
  std::size_t n_packs = 0, n_joints = 0;
  for (std::size_t begin = 0; begin < bonds.size(); begin += pack)
    {
      const auto first = bonds.begin() + std::ptrdiff_t(begin);
      const auto n_broken = std::count_if(first, bonds.begin() + std::ptrdiff_t(std::min(begin + pack, bonds.size())),
                                          [](const Bonds of_joint) { return of_joint != all; });
      n_packs += n_broken > 0;
      n_joints += std::size_t(n_broken);
    }
  return n_packs - (n_joints + pack - 1) / pack;
}

template <int dim>
bool JointGroups<dim>::gather(Joints<dim>& joints)
{
  if (!has_changed)
    return false;
  has_changed = false;
  if (16 * pack * n_spared() <= bonds.size())
    return false;
  std::vector<std::size_t> taken;
  for (std::size_t begin = 0; begin < bonds.size(); begin += window)
    {
      taken.resize(std::min(window, bonds.size() - begin));
      std::iota(taken.begin(), taken.end(), begin);
      std::sort(taken.begin(), taken.end(), [&](const std::size_t a, const std::size_t b) {
        return std::pair(bonds[a], joints.number[a]) < std::pair(bonds[b], joints.number[b]);
      });
      joints.reorder(begin, taken);
    }
  *this = JointGroups(joints);
  has_changed = false;
  return true;
}

template class JointGroups<2>;
template class JointGroups<3>;
} // namespace feldspar

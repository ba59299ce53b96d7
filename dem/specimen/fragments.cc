#include "dem/specimen/fragments.h"

#include <algorithm>
#include <numeric>

namespace feldspar
{
namespace
{
template <int dim>
DisjointSets connected(const Joints<dim>& joints, const std::size_t n_grains, const Faces faces)
{
  DisjointSets sets(n_grains);
  for (std::size_t j = 0; j < joints.size(); ++j)
    if (faces == Faces::all || joints.holds(j))
      sets.merge(joints.grain_1[j], joints.grain_2[j]);
  return sets;
}

} // namespace

std::vector<std::uint32_t> fragments(DisjointSets sets, const std::size_t n_grains)
{
  const std::vector<std::uint32_t> n_members = sets.sizes();
  std::vector<std::uint32_t> by_size(n_grains);
  std::iota(by_size.begin(), by_size.end(), 0u);
  std::ranges::stable_sort(by_size, [&](const auto a, const auto b) { return n_members[a] > n_members[b]; });
  std::vector<std::uint32_t> rank(n_grains);
  for (std::uint32_t k = 0; k < n_grains; ++k)
    rank[by_size[k]] = k;

  std::vector<std::uint32_t> number(n_grains);
  for (std::uint32_t i = 0; i < n_grains; ++i)
    number[i] = rank[sets.root(i)];
  return number;
}

template <int dim>
DisjointSets connected_grains(const Specimen<dim>& specimen, const Faces faces)
{
  const std::size_t n_grains = specimen.grains.size();
  DisjointSets sets = connected(specimen.joints, n_grains, faces);
  for (const auto& joint : specimen.smooth_joints)
    if (faces == Faces::all || joint.state.bonded)
      sets.merge(joint.grain_1, joint.grain_2);
  if (specimen.groups_are_rigid)
    {
      std::vector<std::uint32_t> member(n_grains, std::uint32_t(n_grains));
      for (std::uint32_t i = 0; i < n_grains; ++i)
        if (auto& known = member[specimen.groups[i]]; known == n_grains)
          known = i;
        else
          sets.merge(known, i);
    }
  return sets;
}

template <int dim>
std::vector<std::uint32_t> fragments(const Joints<dim>& joints, const std::size_t n_grains)
{
  return fragments(connected(joints, n_grains, Faces::bonded), n_grains);
}

template <int dim>
std::vector<std::uint32_t> fragments(const Specimen<dim>& specimen)
{
  return fragments(connected_grains(specimen, Faces::bonded), specimen.grains.size());
}

template <int dim>
std::vector<bool> loose_grains(const Specimen<dim>& specimen)
{
  constexpr std::uint32_t most_grains = 10; // of a fragment that is loose
  const auto fragment = fragments(specimen);
  std::vector<std::uint32_t> size(fragment.size(), 0);
  for (const std::uint32_t number : fragment)
    ++size[number];
  std::vector<bool> is_loose(fragment.size());
  for (std::size_t i = 0; i < fragment.size(); ++i)
    is_loose[i] = fragment[i] > 0 && size[fragment[i]] <= most_grains;
  return is_loose;
}

template DisjointSets connected_grains(const Specimen<2>&, Faces);
template DisjointSets connected_grains(const Specimen<3>&, Faces);
template std::vector<std::uint32_t> fragments<2>(const Specimen<2>&);
template std::vector<std::uint32_t> fragments<3>(const Specimen<3>&);
template std::vector<bool> loose_grains<2>(const Specimen<2>&);
template std::vector<bool> loose_grains<3>(const Specimen<3>&);
template std::vector<std::uint32_t> fragments<2>(const Joints<2>&, std::size_t);
template std::vector<std::uint32_t> fragments<3>(const Joints<3>&, std::size_t);
} // namespace feldspar

#include "dem/specimen/fragments.h"

#include "base/disjoint_sets.h"

#include <algorithm>
#include <numeric>

namespace feldspar
{
template <int dim>
std::vector<std::uint32_t> fragments(const Joints<dim>& joints, const std::size_t n_grains)
{
  DisjointSets sets(n_grains);
  for (std::size_t j = 0; j < joints.size(); ++j)
    if (joints.holds(j))
      sets.merge(joints.grain_1[j], joints.grain_2[j]);

  const std::vector<std::uint32_t> n_members = sets.sizes();
  std::vector<std::uint32_t> by_size(n_grains);
  std::iota(by_size.begin(), by_size.end(), 0u);
  std::stable_sort(by_size.begin(), by_size.end(),
                   [&](const auto a, const auto b) { return n_members[a] > n_members[b]; });
  std::vector<std::uint32_t> rank(n_grains);
  for (std::uint32_t k = 0; k < n_grains; ++k)
    rank[by_size[k]] = k;

  std::vector<std::uint32_t> number(n_grains);
  for (std::uint32_t i = 0; i < n_grains; ++i)
    number[i] = rank[sets.root(i)];
  return number;
}

template std::vector<std::uint32_t> fragments<2>(const Joints<2>&, std::size_t);
template std::vector<std::uint32_t> fragments<3>(const Joints<3>&, std::size_t);
} // namespace feldspar

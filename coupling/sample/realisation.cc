#include "coupling/sample/realisation.h"

namespace feldspar
{
template <int dim>
Realisation<dim> realisation(const Specimen<dim>& specimen, const Boundary& boundary)
{
  const auto under = [&](const Boundary& one) {
    return std::make_shared<const Network<dim>>(specimen, Tensor<dim>::Identity(), one);
  };
  if (boundary.kind != BoundaryKind::edge)
    return under(boundary);
  return {under({}), under({.kind = BoundaryKind::edge, .free_axis = 0})};
}

template <int dim>
std::vector<MineralShare> minerals_of(const std::vector<Realisation<dim>>& realisations)
{
  std::vector<MineralShare> minerals;
  for (const Realisation<dim>& one : realisations)
    for (const auto& [mineral, n_grains, share] : one.inside->minerals())
      {
        const std::size_t k = number_of_mineral(minerals, mineral.name) - 1;
        if (k == minerals.size())
          minerals.push_back({mineral});
        minerals[k].n_grains += n_grains;
        minerals[k].share += share / double(realisations.size());
      }
  return minerals;
}

template std::vector<MineralShare> minerals_of(const std::vector<Realisation<2>>&);
template std::vector<MineralShare> minerals_of(const std::vector<Realisation<3>>&);
template Realisation<2> realisation<2>(const Specimen<2>&, const Boundary&);
template Realisation<3> realisation<3>(const Specimen<3>&, const Boundary&);
} // namespace feldspar

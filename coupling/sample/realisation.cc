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

template Realisation<2> realisation<2>(const Specimen<2>&, const Boundary&);
template Realisation<3> realisation<3>(const Specimen<3>&, const Boundary&);
} // namespace feldspar

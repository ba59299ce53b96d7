#pragma once

#include "coupling/network/voigt_tensor.h"

namespace feldspar::tests
{
/// A stress in Voigt's order as a tensor.
template <int dim>
Tensor<dim> stress_tensor(const Voigt<dim>& stress)
{
  Tensor<dim> tensor;
  for (int k = 0; k < n_voigt<dim>; ++k)
    {
      const auto [i, j] = voigt_pair<dim>(k);
      tensor(i, j) = tensor(j, i) = stress[k];
    }
  return tensor;
}
} // namespace feldspar::tests

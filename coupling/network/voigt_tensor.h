#pragma once

#include "base/vector.h"
#include "base/voigt.h"

namespace feldspar
{
template <int dim>
Tensor<dim> strain_tensor(const Voigt<dim>& strain)
{
  Tensor<dim> tensor;
  for (int k = 0; k < n_voigt<dim>; ++k)
    {
      const auto [i, j] = voigt_pair<dim>(k);
      tensor(i, j) = tensor(j, i) = strain[k] / engineering_factor<dim>(k);
    }
  return tensor;
}

template <int dim>
Voigt<dim> strain_voigt(const Tensor<dim>& tensor)
{
  Voigt<dim> strain;
  for (int k = 0; k < n_voigt<dim>; ++k)
    {
      const auto [i, j] = voigt_pair<dim>(k);
      strain[k] = i == j ? tensor(i, i) : tensor(i, j) + tensor(j, i);
    }
  return strain;
}

/// The symmetric part.
template <int dim>
Voigt<dim> stress_voigt(const Tensor<dim>& tensor)
{
  Voigt<dim> stress;
  for (int k = 0; k < n_voigt<dim>; ++k)
    {
      const auto [i, j] = voigt_pair<dim>(k);
      stress[k] = 0.5 * (tensor(i, j) + tensor(j, i));
    }
  return stress;
}
} // namespace feldspar

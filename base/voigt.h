#pragma once

#include <Eigen/Core>

#include <string>
#include <utility>

/// Symmetric tensors as columns: xx, yy, xy in the plane; xx, yy, zz, yz, xz, xy in space. Strains carry engineering
/// shear (γ = 2ε), so that stress · strain is work per volume.
namespace feldspar
{
template <int dim>
inline constexpr int n_voigt = dim*(dim + 1) / 2;

template <int dim>
using Voigt = Eigen::Matrix<double, n_voigt<dim>, 1>;

/// Stress per strain [Pa].
template <int dim>
using Stiffness = Eigen::Matrix<double, n_voigt<dim>, n_voigt<dim>>;

/// Engineering over tensor strain of a component: 1, of shear 2.
template <int dim>
constexpr double engineering_factor(const int k)
{
  return k < dim ? 1.0 : 2.0;
}

/// Row and column of a Voigt component.
template <int dim>
constexpr std::pair<int, int> voigt_pair(const int k)
{
  if constexpr (dim == 2)
    return k < 2 ? std::pair(k, k) : std::pair(0, 1);
  else
    return k < 3 ? std::pair(k, k) : k == 3 ? std::pair(1, 2) : k == 4 ? std::pair(0, 2) : std::pair(0, 1);
}

/// "xx", "yz", …
template <int dim>
std::string voigt_name(const int k)
{
  const auto [i, j] = voigt_pair<dim>(k);
  return {"xyz"[i], "xyz"[j]};
}
} // namespace feldspar

#pragma once

#include <Eigen/Core>

#include <array>

namespace feldspar
{
/// Number of rotations of a rigid grain: 1 in the plane, 3 in space.
template <int dim>
inline constexpr int n_rotations = dim*(dim - 1) / 2;

/// A point, displacement, velocity or force; [dim].
template <int dim>
using Vector = Eigen::Matrix<double, dim, 1>;

/// A rotation, spin or couple, about the axis out of the plane in 2D; [1] in 2D, [3] in 3D.
template <int dim>
using Rotation = Eigen::Matrix<double, n_rotations<dim>, 1>;

/// A second-order tensor; [dim × dim].
template <int dim>
using Tensor = Eigen::Matrix<double, dim, dim>;

/// The last entry of a plane vector is 0.
template <int dim>
std::array<double, 3> in_space(const Vector<dim>& vector)
{
  std::array<double, 3> point{};
  for (int c = 0; c < dim; ++c)
    point[c] = vector[c];
  return point;
}
} // namespace feldspar

#pragma once

#include "base/vector.h"
#include "laboratory/parameters.h"

#include <cstddef>

namespace feldspar
{
/// Acceleration of all grains of a test [m/s²].
template <int dim>
Vector<dim> gravity_of(const TestParameters& wanted)
{
  Vector<dim> acceleration = Vector<dim>::Zero();
  for (std::size_t c = 0; c < wanted.gravity.size(); ++c)
    acceleration[Eigen::Index(c)] = wanted.gravity[c];
  return acceleration;
}
} // namespace feldspar

#pragma once

#include "coupling/network/network.h"
#include "coupling/network/network_state.h"

#include <cstdint>

namespace feldspar
{
/// The RVE at one point of a sample.
template <int dim>
struct SampleRve
{
  std::uint64_t number;        ///< of the point, as cracks name it
  Vector<dim> position;        ///< in the axes of the material [m]; fem/solid/kinematics.h
  Tensor<dim> orientation;     ///< turns the axes of the RVE into those of the material
  const Network<dim>* network; ///< of the realisation assigned to it
  NetworkState<dim> state;
};
} // namespace feldspar

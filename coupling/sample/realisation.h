#pragma once

#include "coupling/network/network_state.h"

#include <memory>
#include <string>
#include <utility>
#include <vector>

namespace feldspar
{
/// A packing as points of a sample get it.
template <int dim>
struct Realisation
{
  Realisation(std::shared_ptr<const Network<dim>> of_inner_points,
              std::shared_ptr<const Network<dim>> of_points_at_sides = nullptr)
    : inside(std::move(of_inner_points))
    , at_side(of_points_at_sides ? std::move(of_points_at_sides) : inside)
  {
  }

  std::shared_ptr<const Network<dim>> inside;
  std::shared_ptr<const Network<dim>> at_side; ///< of elements on a free side; an edge, or as inside
  std::string rock;                            ///< for the cells of this rock alone; empty: for all that have none
};

/// Minerals of all realisations, a name once: their grains, and the means of their shares.
template <int dim>
std::vector<MineralShare> minerals_of(const std::vector<Realisation<dim>>& realisations);

/// Realisation under a boundary; of the boundary of edges: periodic inside, and open along the first axis at sides.
template <int dim>
Realisation<dim> realisation(const Specimen<dim>& specimen, const Boundary& boundary);

/// The representative volume at a point, in its accepted state.
template <int dim>
struct GrainStructure
{
  Tensor<dim> orientation;     ///< turns the axes of the RVE into those of the material
  const Network<dim>* network; ///< of the realisation assigned to the point
  NetworkState<dim> state;
};

/// The RVE at one point of a sample.
template <int dim>
struct SampleRve : GrainStructure<dim>
{
  std::uint64_t number; ///< of the point, as cracks name it
  Vector<dim> position; ///< in the axes of the material [m]; fem/solid/kinematics.h
};
} // namespace feldspar

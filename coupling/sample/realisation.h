#pragma once

#include "coupling/network/network.h"

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
  Realisation(std::shared_ptr<const Network<dim>> of_all)
    : inside(of_all)
    , at_side(std::move(of_all))
  {
  }
  Realisation(std::shared_ptr<const Network<dim>> of_inner_points,
              std::shared_ptr<const Network<dim>> of_points_at_sides)
    : inside(std::move(of_inner_points))
    , at_side(std::move(of_points_at_sides))
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
} // namespace feldspar

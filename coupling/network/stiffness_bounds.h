#pragma once

#include "coupling/network/network.h"

/// Influence of the boundary of an RVE on its elasticity: the same grains and joints under the weakest and the
/// strictest hold on their boundary. All other boundaries lie between them; docs/theory.md §9.6.
namespace feldspar
{
template <int dim>
struct StiffnessBounds
{
  Stiffness<dim> minimal_kinematic; ///< [Pa], Voigt with engineering shear; zero where no joint leads over a side
  Stiffness<dim> affine;            ///< [Pa]
};

/// Bounds with all bonds intact, of the specimen turned by a rotation.
template <int dim>
StiffnessBounds<dim> stiffness_bounds(const Specimen<dim>& specimen,
                                      const Tensor<dim>& rotation = Tensor<dim>::Identity())
{
  const auto stiffness = [&](const BoundaryKind kind) {
    return Network<dim>(specimen, rotation, {.kind = kind}).intact_stiffness();
  };
  return {stiffness(BoundaryKind::minimal_kinematic), stiffness(BoundaryKind::affine)};
}
} // namespace feldspar

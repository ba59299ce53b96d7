#pragma once

#include "fem/solid/boundary_work.h"
#include "fem/solid/discretisation.h"
#include "fem/solid/material_points.h"

#include <map>
#include <string>
#include <vector>

namespace feldspar::fem
{
/// The state of the nodes and points of a solid under a load.
template <int material_dim>
struct SolidState
{
  NodalVector displacement;   ///< with ghosts [m]
  NodalVector internal_force; ///< on all nodes, as if nothing were held [N]
  NodalVector external_force; ///< of the pressures [N]
  std::vector<StrainVector<material_dim>> strains;
  std::vector<MaterialResponse<material_dim>> responses;
  std::vector<StressVector<material_dim>>
    stress_drops{};                        ///< by the events of the last step, each at a held strain [Pa]
  std::map<std::string, double> pressures; ///< on boundaries by their names [Pa]
  BoundaryWork work{};                     ///< on the way here from rest, the same on every rank
};

/// The quadrature points of this rank, in the order of its cells.
template <int material_dim>
struct SolidPoints
{
  MaterialPoints<material_dim> materials;
  std::vector<PointPlace> places;
  std::vector<double> volumes; ///< [m³]
};

template <int dim, int material_dim>
SolidPoints<material_dim> make_points(const Discretisation<dim>& elements, const Material<material_dim>& material);

/// State at rest, with the responses of the points to no strain. Collective.
template <int dim, int material_dim>
SolidState<material_dim> state_at_rest(const Discretisation<dim>& elements,
                                       const MaterialPoints<material_dim>& materials);

/// The strain at each point of this rank.
template <int dim, int material_dim>
std::vector<StrainVector<material_dim>> strains_of(const Discretisation<dim>& elements,
                                                   const NodalVector& displacement);
} // namespace feldspar::fem

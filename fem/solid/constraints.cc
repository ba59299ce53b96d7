#include "fem/solid/constraints.h"

#include <deal.II/base/function.h>
#include <deal.II/base/mpi.h>
#include <deal.II/numerics/vector_tools_boundary.h>

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <limits>
#include <map>
#include <utility>

namespace feldspar::fem
{
using namespace dealii;

namespace
{
template <int dim>
bool follows_along(const Load<dim>& load, const typename Load<dim>::Displacement& displacement)
{
  return load.follower && load.follower->plate == displacement.boundary &&
         load.follower->component == displacement.component;
}

/// The vertex of any rank that is next to a position; of several the first by its coordinates.
template <int dim>
Point<dim> nearest_vertex(const Discretisation<dim>& elements, const Point<dim>& position)
{
  std::array<double, dim + 1> nearest; // distance, then coordinates
  nearest.fill(std::numeric_limits<double>::infinity());
  for (const auto& cell : elements.owned_cells())
    for (const unsigned int v : cell->vertex_indices())
      {
        std::array<double, dim + 1> candidate{cell->vertex(v).distance(position)};
        for (unsigned int c = 0; c < dim; ++c)
          candidate[c + 1] = cell->vertex(v)[c];
        nearest = std::min(nearest, candidate);
      }
  const auto first = std::ranges::min(Utilities::MPI::all_gather(elements.communicator(), nearest));
  Point<dim> vertex;
  for (unsigned int c = 0; c < dim; ++c)
    vertex[c] = first[c + 1];
  return vertex;
}

/// The constraints of the first correction. What is held first stays held so.
template <int dim>
AffineConstraints<double> first_constraints(const Discretisation<dim>& elements, const Load<dim>& load,
                                            const NodalVector& accepted, const double fraction)
{
  AffineConstraints<double> constraints(elements.relevant);
  const auto is_free_here = [&](const types::global_dof_index dof) {
    return elements.relevant.is_element(dof) && !constraints.is_constrained(dof);
  };
  for (const auto& displacement : load.displacements)
    {
      const VectorFunctionFromScalarFunctionObject<dim> function(displacement.value, displacement.component, dim);
      std::map<types::global_dof_index, double> values;
      VectorTools::interpolate_boundary_values(elements.mapping, elements.dof_handler,
                                               elements.mesh.boundary(displacement.boundary), function, values,
                                               only<dim>(displacement.component));
      for (const auto& [dof, value] : values)
        if (is_free_here(dof))
          {
            constraints.add_line(dof);
            if (!follows_along(load, displacement))
              constraints.set_inhomogeneity(dof, fraction * (value - accepted(dof)));
          }
    }
  for (const auto& pin : load.pins)
    {
      const Point<dim> vertex = nearest_vertex(elements, pin.position);
      for (const auto& cell : elements.dof_handler.active_cell_iterators())
        if (!cell->is_artificial())
          for (const unsigned int v : cell->vertex_indices())
            if (cell->vertex(v).distance(vertex) < 1e-9 * cell->diameter())
              if (const auto dof = cell->vertex_dof_index(v, pin.component); !constraints.is_constrained(dof))
                {
                  constraints.add_line(dof);
                  constraints.set_inhomogeneity(dof, -fraction * accepted(dof));
                }
    }
  for (const auto& plate : load.free_plates)
    {
      const IndexSet on_plate = elements.dofs_on(plate.boundary, plate.component);
      types::global_dof_index leader = numbers::invalid_dof_index;
      for (const auto dof : on_plate)
        if (!constraints.is_constrained(dof))
          leader = std::min(leader, dof);
      leader = Utilities::MPI::min(leader, elements.communicator());
      for (const auto dof : on_plate)
        if (dof != leader && is_free_here(dof))
          {
            constraints.add_line(dof);
            constraints.add_entry(dof, leader, 1.0);
          }
    }
  constraints.close();
  return constraints;
}

template <int dim>
SolidConstraints::Following following(const Discretisation<dim>& elements, const typename Load<dim>::Follower& follower,
                                      const AffineConstraints<double>& standing, const NodalVector& accepted,
                                      const double fraction)
{
  AffineConstraints<double> unit;
  unit.copy_from(standing);
  for (const auto dof : elements.dofs_on(follower.plate, follower.component))
    if (unit.is_constrained(dof))
      unit.set_inhomogeneity(dof, 1.0);
  const double before = elements.swept_volume(follower.boundaries, accepted);
  return {follower.boundaries, before, before + fraction * (follower.swept_volume - before), std::move(unit)};
}

template <int dim>
std::string places_of(const Load<dim>& load)
{
  std::string places;
  for (const auto& displacement : load.displacements)
    places += fmt::format("displacement {} {}\n", displacement.boundary, displacement.component);
  for (const auto& pin : load.pins)
    {
      places += fmt::format("pin {}", pin.component);
      for (unsigned int c = 0; c < dim; ++c)
        places += fmt::format(" {}", pin.position[c]);
      places += '\n';
    }
  for (const auto& plate : load.free_plates)
    places += fmt::format("plate {} {}\n", plate.boundary, plate.component);
  return places;
}
} // namespace

template <int dim>
SolidConstraints constrain(const Discretisation<dim>& elements, const Load<dim>& load, const NodalVector& accepted,
                           const double fraction)
{
  SolidConstraints constraints{first_constraints(elements, load, accepted, fraction),
                               AffineConstraints<double>(),
                               {},
                               places_of(load)};
  constraints.standing.copy_from(constraints.first);
  for (const auto& line : constraints.first.get_lines())
    constraints.standing.set_inhomogeneity(line.index, 0.0);
  if (load.follower)
    constraints.following.emplace(following(elements, *load.follower, constraints.standing, accepted, fraction));
  return constraints;
}

template SolidConstraints constrain(const Discretisation<2>&, const Load<2>&, const NodalVector&, double);
template SolidConstraints constrain(const Discretisation<3>&, const Load<3>&, const NodalVector&, double);
} // namespace feldspar::fem

#include "fem/solid/constraints.h"

#include <deal.II/base/mpi.h>
#include <deal.II/dofs/dof_tools.h>
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
/// A function of position as one component of a displacement.
template <int dim>
class OneComponent : public Function<dim>
{
public:
  OneComponent(const unsigned int its_component, const std::function<double(const Point<dim>&)>& its_function)
    : Function<dim>(dim)
    , component(its_component)
    , function(its_function)
  {
  }

  double value(const Point<dim>& position, const unsigned int wanted) const override
  {
    return wanted == component ? function(position) : 0.0;
  }

private:
  unsigned int component;
  const std::function<double(const Point<dim>&)>& function;
};

template <int dim>
bool follows_along(const Load<dim>& load, const typename Load<dim>::Displacement& displacement)
{
  return load.follower && load.follower->plate == displacement.boundary &&
         load.follower->component == displacement.component;
}

/// The vertex of any rank that is next to a position; of several the first by its coordinates.
template <int dim>
Point<dim> nearest_vertex(const DoFHandler<dim>& dof_handler, const Point<dim>& position)
{
  using Candidate = std::array<double, dim + 1>; // distance, then coordinates
  constexpr double infinity = std::numeric_limits<double>::infinity();
  Candidate nearest;
  nearest.fill(infinity);
  for (const auto& cell : dof_handler.active_cell_iterators())
    if (cell->is_locally_owned())
      for (const unsigned int v : cell->vertex_indices())
        {
          Candidate candidate{cell->vertex(v).distance(position)};
          for (unsigned int c = 0; c < dim; ++c)
            candidate[c + 1] = cell->vertex(v)[c];
          nearest = std::min(nearest, candidate);
        }
  // The first of all ranks' candidates, entry by entry among those that are equal so far.
  bool in_the_race = true;
  Candidate first;
  for (unsigned int entry = 0; entry <= dim; ++entry)
    {
      first[entry] = Utilities::MPI::min(in_the_race ? nearest[entry] : infinity, dof_handler.get_communicator());
      in_the_race = in_the_race && nearest[entry] == first[entry];
    }
  Point<dim> vertex;
  for (unsigned int c = 0; c < dim; ++c)
    vertex[c] = first[c + 1];
  return vertex;
}

/// The constraints of one load as they are gathered: what is held first stays held so.
template <int dim>
class Gathering
{
public:
  Gathering(const Discretisation<dim>& its_elements, const NodalVector& its_accepted, const double its_fraction)
    : elements(its_elements)
    , accepted(its_accepted)
    , fraction(its_fraction)
    , constraints(elements.relevant)
  {
  }

  void add_displacements(const Load<dim>& load)
  {
    for (const auto& displacement : load.displacements)
      {
        const OneComponent<dim> function(displacement.component, displacement.value);
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
  }

  void add_pins(const Load<dim>& load)
  {
    for (const auto& pin : load.pins)
      {
        const Point<dim> vertex = nearest_vertex(elements.dof_handler, pin.position);
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
  }

  void add_free_plates(const Load<dim>& load)
  {
    for (const auto& plate : load.free_plates)
      {
        const IndexSet on_plate = DoFTools::extract_boundary_dofs(elements.dof_handler, only<dim>(plate.component),
                                                                  {elements.mesh.boundary(plate.boundary)});
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
  }

  AffineConstraints<double> closed() &&
  {
    constraints.close();
    return std::move(constraints);
  }

private:
  bool is_free_here(const types::global_dof_index dof) const
  {
    return elements.relevant.is_element(dof) && !constraints.is_constrained(dof);
  }

  const Discretisation<dim>& elements;
  const NodalVector& accepted;
  double fraction;
  AffineConstraints<double> constraints;
};

template <int dim>
SolidConstraints::Following following(const Discretisation<dim>& elements, const typename Load<dim>::Follower& follower,
                                      const AffineConstraints<double>& standing, const NodalVector& accepted,
                                      const double fraction)
{
  AffineConstraints<double> unit;
  unit.copy_from(standing);
  const IndexSet on_plate = DoFTools::extract_boundary_dofs(elements.dof_handler, only<dim>(follower.component),
                                                            {elements.mesh.boundary(follower.plate)});
  for (const auto dof : on_plate)
    if (unit.is_constrained(dof))
      unit.set_inhomogeneity(dof, 1.0);
  const double before = swept_between(elements, follower.boundaries, accepted);
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
double swept_between(const Discretisation<dim>& elements, const std::vector<std::string>& boundaries,
                     const NodalVector& displacement)
{
  double swept = 0.0;
  for (const std::string& boundary : boundaries)
    swept += elements.swept_volume(boundary, displacement);
  return swept;
}

template <int dim>
SolidConstraints constrain(const Discretisation<dim>& elements, const Load<dim>& load, const NodalVector& accepted,
                           const double fraction)
{
  Gathering<dim> gathering(elements, accepted, fraction);
  gathering.add_displacements(load);
  gathering.add_pins(load);
  gathering.add_free_plates(load);
  SolidConstraints constraints{std::move(gathering).closed(), AffineConstraints<double>(), {}, places_of(load)};
  constraints.standing.copy_from(constraints.first);
  for (const auto& line : constraints.first.get_lines())
    constraints.standing.set_inhomogeneity(line.index, 0.0);
  if (load.follower)
    constraints.following.emplace(following(elements, *load.follower, constraints.standing, accepted, fraction));
  return constraints;
}

template SolidConstraints constrain(const Discretisation<2>&, const Load<2>&, const NodalVector&, double);
template SolidConstraints constrain(const Discretisation<3>&, const Load<3>&, const NodalVector&, double);
template double swept_between(const Discretisation<2>&, const std::vector<std::string>&, const NodalVector&);
template double swept_between(const Discretisation<3>&, const std::vector<std::string>&, const NodalVector&);
} // namespace feldspar::fem

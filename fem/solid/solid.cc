#include "fem/solid/solid.h"

#include "fem/mesh/partition.h"

#include <deal.II/base/mpi.h>
#include <deal.II/base/quadrature_lib.h>
#include <deal.II/base/timer.h>
#include <deal.II/dofs/dof_tools.h>
#include <deal.II/fe/fe_q.h>
#include <deal.II/fe/fe_values.h>
#include <deal.II/lac/dynamic_sparsity_pattern.h>
#include <deal.II/lac/full_matrix.h>
#include <deal.II/lac/sparsity_tools.h>
#include <deal.II/numerics/vector_tools_boundary.h>

#include <boost/serialization/string.hpp>
#include <boost/serialization/vector.hpp>
#include <fmt/format.h>
#include <oneapi/tbb/task_arena.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numeric>
#include <utility>

namespace feldspar::fem
{
using namespace dealii;

namespace
{
unsigned int n_quadrature_points(const SolidParameters& parameters)
{
  if (parameters.order != 1 && parameters.order != 2)
    throw std::invalid_argument("shape functions have order 1 or 2");
  if (parameters.reduced_quadrature && parameters.order == 1)
    throw std::invalid_argument("order 1 with reduced quadrature lets cells deform without strain");
  return parameters.reduced_quadrature ? parameters.order : parameters.order + 1;
}

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
ComponentMask only(const unsigned int component)
{
  ComponentMask mask(dim, false);
  mask.set(component, true);
  return mask;
}
} // namespace

template <int dim, int material_dim>
Solid<dim, material_dim>::Solid(const SampleMesh<dim>& its_mesh, const SolidParameters& its_parameters,
                                const Material<material_dim>& its_material)
  : mesh(its_mesh)
  , parameters(its_parameters)
  , material(its_material)
  , mapping(parameters.reduced_quadrature
              ? 1
              : parameters.order) // reduced: too few points for constant stress in curved cells
  , fe(FE_Q<dim>(parameters.order), dim)
  , quadrature(n_quadrature_points(parameters))
  , face_quadrature(parameters.order + 1)
  , dof_handler(*mesh.triangulation)
{
  set_up();
}

template <int dim, int material_dim>
void Solid<dim, material_dim>::set_up()
{
  set_up_dofs();
  place_on_curve();
  set_up_points();
}

template <int dim, int material_dim>
void Solid<dim, material_dim>::set_up_dofs()
{
  dof_handler.distribute_dofs(fe);
  owned = dof_handler.locally_owned_dofs();
  DoFTools::extract_locally_relevant_dofs(dof_handler, relevant);
  // Assigned to each other later, which PETSc takes only where ranks have as many entries of both.
  for (State* const state : {&accepted, &tried})
    {
      state->displacement.reinit(owned, relevant, communicator());
      state->internal_force.reinit(owned, communicator());
      state->external_force.reinit(owned, communicator());
    }
  right_side.reinit(owned, communicator());
  constraints.reinit(relevant);
  constraints.close();
  constrained.clear();
  matrix.clear();
}

namespace
{
/// Of all cells of a mesh whose coarse cells are all refined as often, in the order of their CellIds.
template <typename Cell>
std::uint64_t number_of(const Cell& cell)
{
  const CellId id = cell->id();
  std::uint64_t number = id.get_coarse_cell_id();
  for (const auto child : id.get_child_indices())
    number = number * GeometryInfo<Cell::AccessorType::dimension>::max_children_per_cell + child;
  return number;
}
} // namespace

template <int dim, int material_dim>
void Solid<dim, material_dim>::set_up_points()
{
  points.clear();
  point_places.clear();
  point_volumes.clear();
  FEValues<dim> values(mapping, fe, quadrature, update_quadrature_points | update_JxW_values);
  for (const auto& cell : dof_handler.active_cell_iterators())
    if (cell->is_locally_owned())
      {
        values.reinit(cell);
        const double measure = std::accumulate(values.get_JxW_values().begin(), values.get_JxW_values().end(), 0.0);
        for (const unsigned int q : values.quadrature_point_indices())
          {
            const Point<dim>& position = values.quadrature_point(q);
            PointPlace place{cell->id().to_string(),
                             number_of(cell),
                             q,
                             {},
                             std::pow(measure, 1.0 / dim) / parameters.order};
            for (unsigned int component = 0; component < dim; ++component)
              place.position.push_back(position[component]);
            points.add(material.make_point(place));
            point_places.push_back(std::move(place));
            point_volumes.push_back(values.JxW(q) * weight(parameters.kinematics, position[0]));
          }
      }
  accepted.strains.assign(points.size(), StrainVector<material_dim>::Zero());
  accepted.answers = points.trial(accepted.strains);
  seconds_noted.assign(points.size() / n_points_per_cell(), 0.0);
}

template <int dim, int material_dim>
void Solid<dim, material_dim>::set_up_constraints(const Load<dim>& load, const double fraction)
{
  first_constraints.clear();
  first_constraints.reinit(relevant);
  constrain_displacements(load, fraction);
  constrain_pins(load, fraction);
  constrain_free_plates(load);
  first_constraints.close();
  constraints.copy_from(first_constraints);
  for (const auto& line : first_constraints.get_lines())
    constraints.set_inhomogeneity(line.index, 0.0);

  follower = load.follower;
  if (follower)
    {
      unit_constraints.copy_from(constraints);
      const IndexSet on_plate =
        DoFTools::extract_boundary_dofs(dof_handler, only<dim>(follower->component), {mesh.boundary(follower->plate)});
      for (const auto dof : on_plate)
        if (unit_constraints.is_constrained(dof))
          unit_constraints.set_inhomogeneity(dof, 1.0);
      swept_before = swept_between(accepted.displacement);
      swept_wanted = swept_before + fraction * (follower->swept_volume - swept_before);
    }

  std::string now_constrained;
  for (const auto& displacement : load.displacements)
    now_constrained += fmt::format("displacement {} {}\n", displacement.boundary, displacement.component);
  for (const auto& pin : load.pins)
    {
      now_constrained += fmt::format("pin {}", pin.component);
      for (unsigned int c = 0; c < dim; ++c)
        now_constrained += fmt::format(" {}", pin.position[c]);
      now_constrained += '\n';
    }
  for (const auto& plate : load.free_plates)
    now_constrained += fmt::format("plate {} {}\n", plate.boundary, plate.component);
  if (now_constrained != constrained || matrix.m() == 0)
    {
      set_up_matrix();
      constrained = now_constrained;
    }
}

template <int dim, int material_dim>
void Solid<dim, material_dim>::set_up_matrix()
{
  // A free plate ties nodes to one that may be of another rank.
  IndexSet rows = relevant;
  for (const auto& line : constraints.get_lines())
    for (const auto& entry : line.entries)
      rows.add_index(entry.first);
  DynamicSparsityPattern pattern(dof_handler.n_dofs(), dof_handler.n_dofs(), rows);
  DoFTools::make_sparsity_pattern(dof_handler, pattern, constraints, false);
  SparsityTools::distribute_sparsity_pattern(pattern, owned, communicator(), rows);
  matrix.reinit(owned, owned, pattern, communicator());
}

namespace
{
template <int dim>
bool follows_along(const Load<dim>& load, const typename Load<dim>::Displacement& displacement)
{
  return load.follower && load.follower->plate == displacement.boundary &&
         load.follower->component == displacement.component;
}
} // namespace

template <int dim, int material_dim>
void Solid<dim, material_dim>::constrain_displacements(const Load<dim>& load, const double fraction)
{
  for (const auto& displacement : load.displacements)
    {
      const OneComponent<dim> function(displacement.component, displacement.value);
      std::map<types::global_dof_index, double> values;
      VectorTools::interpolate_boundary_values(mapping, dof_handler, mesh.boundary(displacement.boundary), function,
                                               values, only<dim>(displacement.component));
      for (const auto& [dof, value] : values)
        if (relevant.is_element(dof) && !first_constraints.is_constrained(dof))
          {
            first_constraints.add_line(dof);
            if (!follows_along(load, displacement))
              first_constraints.set_inhomogeneity(dof, fraction * (value - accepted.displacement(dof)));
          }
    }
}

namespace
{
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
} // namespace

template <int dim, int material_dim>
void Solid<dim, material_dim>::constrain_pins(const Load<dim>& load, const double fraction)
{
  for (const auto& pin : load.pins)
    {
      const Point<dim> vertex = nearest_vertex(dof_handler, pin.position);
      for (const auto& cell : dof_handler.active_cell_iterators())
        if (!cell->is_artificial())
          for (const unsigned int v : cell->vertex_indices())
            if (cell->vertex(v).distance(vertex) < 1e-9 * cell->diameter())
              if (const auto dof = cell->vertex_dof_index(v, pin.component); !first_constraints.is_constrained(dof))
                {
                  first_constraints.add_line(dof);
                  first_constraints.set_inhomogeneity(dof, -fraction * accepted.displacement(dof));
                }
    }
}

template <int dim, int material_dim>
void Solid<dim, material_dim>::constrain_free_plates(const Load<dim>& load)
{
  for (const auto& plate : load.free_plates)
    {
      const IndexSet on_plate =
        DoFTools::extract_boundary_dofs(dof_handler, only<dim>(plate.component), {mesh.boundary(plate.boundary)});
      types::global_dof_index leader = numbers::invalid_dof_index;
      for (const auto dof : on_plate)
        if (!first_constraints.is_constrained(dof))
          leader = std::min(leader, dof);
      leader = Utilities::MPI::min(leader, communicator());
      for (const auto dof : on_plate)
        if (dof != leader && relevant.is_element(dof) && !first_constraints.is_constrained(dof))
          {
            first_constraints.add_line(dof);
            first_constraints.add_entry(dof, leader, 1.0);
          }
    }
}

template <int dim, int material_dim>
double Solid<dim, material_dim>::pressure_of(const State& state, const types::boundary_id boundary) const
{
  double pressure = 0.0;
  for (const auto& [name, value] : state.pressures)
    if (mesh.boundary(name) == boundary)
      pressure += value;
  return pressure;
}

/// Internal and external force on every node, and in right_side the unbalanced force on what is free to move.
template <int dim, int material_dim>
void Solid<dim, material_dim>::assemble_forces(State& state)
{
  FEValues<dim> values(mapping, fe, quadrature, update_values | update_gradients | update_quadrature_points);
  FEFaceValues<dim> face_values(mapping, fe, face_quadrature,
                                update_values | update_normal_vectors | update_quadrature_points | update_JxW_values);
  const unsigned int n_dofs = fe.n_dofs_per_cell();
  dealii::Vector<double> internal(n_dofs);
  dealii::Vector<double> external(n_dofs);
  std::vector<types::global_dof_index> dofs(n_dofs);
  state.internal_force = 0.0;
  state.external_force = 0.0;
  right_side = 0.0;
  std::size_t point = 0;
  for (const auto& cell : dof_handler.active_cell_iterators())
    if (cell->is_locally_owned())
      {
        values.reinit(cell);
        internal = 0.0;
        external = 0.0;
        for (const unsigned int q : values.quadrature_point_indices())
          {
            const double radius = values.quadrature_point(q)[0];
            for (const unsigned int i : values.dof_indices())
              internal[i] += strain_of<dim, material_dim>(parameters.kinematics, fe.system_to_component_index(i).first,
                                                          values.shape_value(i, q), values.shape_grad(i, q), radius)
                               .dot(state.answers[point].stress) *
                             point_volumes[point];
            ++point;
          }
        for (const auto& face : cell->face_iterators())
          if (face->at_boundary())
            if (const double pressure = pressure_of(state, face->boundary_id()); pressure != 0.0)
              {
                face_values.reinit(cell, face);
                for (const unsigned int q : face_values.quadrature_point_indices())
                  for (const unsigned int i : face_values.dof_indices())
                    external[i] -= pressure * face_values.normal_vector(q)[fe.system_to_component_index(i).first] *
                                   face_values.shape_value(i, q) * face_values.JxW(q) *
                                   weight(parameters.kinematics, face_values.quadrature_point(q)[0]);
              }
        cell->get_dof_indices(dofs);
        state.internal_force.add(dofs, internal);
        state.external_force.add(dofs, external);
        external -= internal;
        constraints.distribute_local_to_global(external, dofs, right_side);
      }
  state.internal_force.compress(VectorOperation::add);
  state.external_force.compress(VectorOperation::add);
  right_side.compress(VectorOperation::add);
}

/// The tangent and the unbalanced force, with the motion of the boundary that the constraints ask for.
template <int dim, int material_dim>
void Solid<dim, material_dim>::assemble_system(const State& state, const AffineConstraints<double>& asked)
{
  FEValues<dim> values(mapping, fe, quadrature, update_values | update_gradients | update_quadrature_points);
  const unsigned int n_dofs = fe.n_dofs_per_cell();
  FullMatrix<double> cell_matrix(n_dofs, n_dofs);
  dealii::Vector<double> no_force(n_dofs);
  Eigen::Matrix<double, n_components<material_dim>, Eigen::Dynamic> B(n_components<material_dim>, n_dofs);
  Eigen::MatrixXd stiffness(n_dofs, n_dofs);
  std::vector<types::global_dof_index> dofs(n_dofs);
  matrix = 0.0;
  std::size_t point = 0;
  for (const auto& cell : dof_handler.active_cell_iterators())
    if (cell->is_locally_owned())
      {
        values.reinit(cell);
        stiffness.setZero();
        for (const unsigned int q : values.quadrature_point_indices())
          {
            const double radius = values.quadrature_point(q)[0];
            for (const unsigned int i : values.dof_indices())
              B.col(i) = strain_of<dim, material_dim>(parameters.kinematics, fe.system_to_component_index(i).first,
                                                      values.shape_value(i, q), values.shape_grad(i, q), radius);
            stiffness.noalias() += B.transpose() * (state.answers[point].tangent * B) * point_volumes[point];
            ++point;
          }
        for (const unsigned int i : values.dof_indices())
          for (const unsigned int j : values.dof_indices())
            cell_matrix(i, j) = stiffness(i, j);
        cell->get_dof_indices(dofs);
        asked.distribute_local_to_global(cell_matrix, no_force, dofs, matrix, right_side);
      }
  matrix.compress(VectorOperation::add);
  right_side.compress(VectorOperation::add);
}

template <int dim, int material_dim>
void Solid<dim, material_dim>::update_strains(State& state) const
{
  FEValues<dim> values(mapping, fe, quadrature, update_values | update_gradients | update_quadrature_points);
  const FEValuesExtractors::Vector displacements(0);
  std::vector<Tensor<1, dim>> u(quadrature.size());
  std::vector<Tensor<2, dim>> gradients(quadrature.size());
  std::size_t point = 0;
  for (const auto& cell : dof_handler.active_cell_iterators())
    if (cell->is_locally_owned())
      {
        values.reinit(cell);
        values[displacements].get_function_values(state.displacement, u);
        values[displacements].get_function_gradients(state.displacement, gradients);
        for (const unsigned int q : values.quadrature_point_indices())
          {
            StrainVector<material_dim> strain = StrainVector<material_dim>::Zero();
            for (unsigned int component = 0; component < dim; ++component)
              strain += strain_of<dim, material_dim>(parameters.kinematics, component, u[q][component],
                                                     gradients[q][component], values.quadrature_point(q)[0]);
            state.strains[point++] = strain;
          }
      }
}

/// False where a point of any rank has no answer.
template <int dim, int material_dim>
bool Solid<dim, material_dim>::update_points(State& state)
{
  bool failed = false;
  try
    {
      state.answers = points.trial(state.strains);
    }
  catch (const PointFailure&)
    {
      failed = true;
    }
  note_round();
  return Utilities::MPI::max(int(failed), communicator()) == 0;
}

template <int dim, int material_dim>
bool Solid<dim, material_dim>::tangents_are_symmetric(const State& state) const
{
  const bool symmetric = std::all_of(state.answers.begin(), state.answers.end(), [](const auto& answer) {
    constexpr double round_off = 1e-10;
    const auto& C = answer.tangent;
    return (C - C.transpose()).cwiseAbs().maxCoeff() <= round_off * C.cwiseAbs().maxCoeff();
  });
  return Utilities::MPI::min(int(symmetric), communicator()) == 1;
}

template <int dim, int material_dim>
NewtonReport Solid<dim, material_dim>::solve(const Load<dim>& load, const double fraction)
{
  reject();
  set_up_constraints(load, fraction);
  tried = accepted;
  // What the new load does not name goes to zero.
  for (auto& [boundary, pressure] : tried.pressures)
    pressure *= 1.0 - fraction;
  for (const auto& pressure : load.pressures)
    {
      mesh.boundary(pressure.boundary);
      tried.pressures[pressure.boundary] += fraction * pressure.value;
    }
  return iterate();
}

/// As much of a correction as all points have an answer to, halved down to a sixteenth; 0 where there is none.
template <int dim, int material_dim>
double Solid<dim, material_dim>::correct(const Vector& correction)
{
  const Vector before = tried.displacement;
  for (double share = 1.0; share > 0.05; share *= 0.5)
    {
      Vector displacement = owned_vector();
      displacement = before;
      displacement.add(share, correction);
      tried.displacement = displacement;
      update_strains(tried);
      if (update_points(tried))
        return share;
    }
  return 0.0;
}

/// Empty where there is none.
template <int dim, int material_dim>
auto Solid<dim, material_dim>::correction_by(const AffineConstraints<double>& asked) -> std::optional<Vector>
{
  assemble_system(tried, asked);
  Vector correction = owned_vector();
  if (!solve_linear(parameters.linear_solver, tangents_are_symmetric(tried), matrix, correction, right_side, dim,
                    parameters.linear_tolerance))
    return {};
  asked.distribute(correction);
  return correction;
}

/// Of two corrections, with the plate standing and moved by a metre, the mixture that lets the boundaries sweep what is
/// wanted.
template <int dim, int material_dim>
auto Solid<dim, material_dim>::following_correction() -> std::optional<Vector>
{
  std::optional<Vector> standing = correction_by(constraints);
  if (!standing)
    return {};
  std::optional<Vector> moved = correction_by(unit_constraints); // adds to the same unbalanced force
  if (!moved)
    return {};
  *moved -= *standing;
  const auto swept_by = [this](const Vector& correction) {
    Vector with_ghosts = tried.displacement;
    with_ghosts = correction;
    return swept_between(with_ghosts);
  };
  const double missing = swept_wanted - swept_between(tried.displacement) - swept_by(*standing);
  const double distance = missing / swept_by(*moved);
  if (!std::isfinite(distance))
    return {};
  standing->add(distance, *moved);
  return standing;
}

/// Its plate has gone as far as was wanted.
template <int dim, int material_dim>
bool Solid<dim, material_dim>::follows() const
{
  constexpr double tolerance = 1e-6; // of the way
  return !follower || std::abs(swept_between(tried.displacement) - swept_wanted) <=
                        tolerance * std::abs(swept_wanted - swept_before);
}

template <int dim, int material_dim>
double Solid<dim, material_dim>::swept_between(const Vector& displacement) const
{
  double swept = 0.0;
  for (const std::string& boundary : follower->boundaries)
    swept += integral(boundary, displacement, [](const auto& u, const auto& normal) { return u * normal; });
  return swept;
}

template <int dim, int material_dim>
NewtonReport Solid<dim, material_dim>::iterate()
{
  NewtonReport report;
  const auto failed = [&](const std::string& why) {
    report.failure = why;
    return report;
  };
  bool boundary_moves = !follower;
  unsigned int n_iterations_left = parameters.most_iterations;
  double force_scale = accepted.internal_force.l2_norm();
  for (;;)
    {
      assemble_forces(tried);
      const double unbalanced = right_side.l2_norm();
      force_scale = std::max({force_scale, tried.internal_force.l2_norm(), tried.external_force.l2_norm()});
      report.residuals.push_back(force_scale > 0.0 ? unbalanced / force_scale : 0.0);
      if (!std::isfinite(unbalanced))
        return failed("the unbalanced force is not finite");

      if (!boundary_moves && unbalanced <= parameters.newton_tolerance * force_scale && follows())
        {
          // Equilibrium with the structure of every point frozen. Does it hold?
          std::uint64_t n_events = 0;
          bool point_failed = false;
          try
            {
              n_events = points.relax(tried.strains);
            }
          catch (const PointFailure&)
            {
              point_failed = true;
            }
          note_round();
          if (Utilities::MPI::max(int(point_failed), communicator()) == 1)
            return failed("a material point found no stable structure");
          n_events = Utilities::MPI::sum(n_events, communicator());
          report.n_events += n_events;
          if (n_events == 0)
            {
              report.converged = true;
              return report;
            }
          ++report.n_cascades;
          if (report.n_events > parameters.most_events)
            return failed(fmt::format("more than {} events", parameters.most_events));
          if (report.n_cascades >= parameters.most_cascades)
            return failed(fmt::format("still unstable after {} cascades", report.n_cascades));
          if (!update_points(tried))
            return failed("a material point has no answer to its strain");
          n_iterations_left = parameters.most_iterations;
          parameters.watch(report);
          continue;
        }

      if (n_iterations_left-- == 0)
        return failed(fmt::format("no equilibrium after {} iterations", parameters.most_iterations));
      const std::optional<Vector> correction =
        follower ? following_correction() : correction_by(boundary_moves ? first_constraints : constraints);
      if (!correction)
        return failed("the tangent is singular or the linear solver did not converge");
      ++report.n_iterations;
      const double share = correct(*correction);
      if (share == 0.0)
        return failed("a material point has no answer to its strain");
      if (boundary_moves)
        {
          for (const auto& line : constraints.get_lines())
            first_constraints.set_inhomogeneity(line.index,
                                                (1.0 - share) * first_constraints.get_inhomogeneity(line.index));
          boundary_moves = share < 1.0;
        }
      parameters.watch(report);
    }
}

template <int dim, int material_dim>
void Solid<dim, material_dim>::accept()
{
  points.accept(tried.strains);
  note_round();
  accepted = tried;
}

template <int dim, int material_dim>
void Solid<dim, material_dim>::reject()
{
  points.reject();
}

template <int dim, int material_dim>
StoredSolid Solid<dim, material_dim>::stored() const
{
  StoredSolid result{{}, accepted.pressures};
  std::vector<types::global_dof_index> dofs(fe.n_dofs_per_cell());
  std::size_t point = 0;
  for (const auto& cell : dof_handler.active_cell_iterators())
    if (cell->is_locally_owned())
      {
        StoredCell stored{number_of(cell), {}, {}, {}};
        cell->get_dof_indices(dofs);
        for (const auto dof : dofs)
          stored.displacement.push_back(accepted.displacement(dof));
        for (unsigned int q = 0; q < n_points_per_cell(); ++q, ++point)
          {
            const auto& [stress, tangent] = accepted.answers[point];
            stored.answers.insert(stored.answers.end(), stress.begin(), stress.end());
            stored.answers.insert(stored.answers.end(), tangent.data(), tangent.data() + tangent.size());
            stored.points.push_back(points[point].stored());
          }
        result.cells.push_back(std::move(stored));
      }
  return result;
}

template <int dim, int material_dim>
void Solid<dim, material_dim>::restore(const StoredSolid& stored)
{
  accepted.pressures = stored.pressures;
  const bool known = std::all_of(stored.cells.begin(), stored.cells.end(),
                                 [&](const StoredCell& cell) { return cell.number < n_cells(); });
  if (Utilities::MPI::min(int(known), communicator()) == 0 || !take(brought_home(stored.cells)))
    throw std::invalid_argument("the state of another mesh");
}

/// The cells of this rank among those that all ranks bring.
template <int dim, int material_dim>
std::vector<StoredCell> Solid<dim, material_dim>::brought_home(const std::vector<StoredCell>& cells) const
{
  IndexSet at_home(n_cells());
  IndexSet brought(n_cells());
  for (const auto& cell : dof_handler.active_cell_iterators())
    if (cell->is_locally_owned())
      at_home.add_index(number_of(cell));
  for (const StoredCell& cell : cells)
    brought.add_index(cell.number);
  const auto owners = Utilities::MPI::compute_index_owner(at_home, brought, communicator());
  std::map<unsigned int, std::vector<StoredCell>> sent;
  for (const StoredCell& cell : cells)
    sent[owners[brought.index_within_set(cell.number)]].push_back(cell);
  std::vector<StoredCell> result;
  for (auto& [rank, received] : Utilities::MPI::some_to_some(communicator(), sent))
    result.insert(result.end(), std::make_move_iterator(received.begin()), std::make_move_iterator(received.end()));
  return result;
}

/// Makes these the accepted state of the cells of this rank. False, on every rank, where they are not all of them.
template <int dim, int material_dim>
bool Solid<dim, material_dim>::take(const std::vector<StoredCell>& cells)
{
  constexpr std::size_t n = n_components<material_dim>;
  const std::size_t n_of_cell = n_points_per_cell();
  std::map<std::uint64_t, const StoredCell*> by_number;
  bool whole = true;
  for (const StoredCell& cell : cells)
    whole = by_number.emplace(cell.number, &cell).second && cell.displacement.size() == fe.n_dofs_per_cell() &&
            cell.answers.size() == (n + n * n) * n_of_cell && cell.points.size() == n_of_cell && whole;
  for (const PointPlace& place : point_places)
    whole = whole && by_number.count(place.cell_number) == 1;
  if (Utilities::MPI::min(int(whole), communicator()) == 0)
    return false;

  Vector displacement = owned_vector();
  std::vector<types::global_dof_index> dofs(fe.n_dofs_per_cell());
  std::vector<std::string> stored_points;
  for (const auto& cell : dof_handler.active_cell_iterators())
    if (cell->is_locally_owned())
      {
        const StoredCell& stored = *by_number.at(number_of(cell));
        cell->get_dof_indices(dofs);
        for (std::size_t i = 0; i < dofs.size(); ++i)
          if (owned.is_element(dofs[i]))
            displacement(dofs[i]) = stored.displacement[i];
        for (std::size_t q = 0; q < n_of_cell; ++q)
          {
            const double* const answer = &stored.answers[q * (n + n * n)];
            auto& [stress, tangent] = accepted.answers[stored_points.size()];
            std::copy_n(answer, n, stress.data());
            std::copy_n(answer + n, n * n, tangent.data());
            stored_points.push_back(stored.points[q]);
          }
      }
  displacement.compress(VectorOperation::insert);
  accepted.displacement = displacement;
  update_strains(accepted);
  bool understood = true;
  try
    {
      points.restore(stored_points);
    }
  catch (const std::exception&)
    {
      understood = false;
    }
  if (Utilities::MPI::min(int(understood), communicator()) == 0)
    return false;
  assemble_forces(accepted);
  return true;
}

template <int dim, int material_dim>
void Solid<dim, material_dim>::place_on_curve()
{
  const auto& trees = mesh.triangulation->get_coarse_cell_to_p4est_tree_permutation();
  std::vector<std::pair<types::global_dof_index, std::uint64_t>> places;
  for (const auto& cell : dof_handler.active_cell_iterators())
    if (cell->is_locally_owned())
      places.emplace_back(trees[cell->id().get_coarse_cell_id()], number_of(cell));
  along_curve.resize(places.size());
  std::iota(along_curve.begin(), along_curve.end(), std::size_t(0));
  std::sort(along_curve.begin(), along_curve.end(),
            [&](const std::size_t one, const std::size_t other) { return places[one] < places[other]; });
  // The ranks' pieces follow each other.
  cuts = {0};
  for (const std::size_t n : Utilities::MPI::all_gather(communicator(), places.size()))
    cuts.push_back(cuts.back() + n);
  if (cuts_at_first.empty())
    cuts_at_first = cuts;
  rank_at_first.resize(places.size());
  const std::size_t begin = cuts[Utilities::MPI::this_mpi_process(communicator())];
  for (std::size_t k = 0; k < along_curve.size(); ++k)
    rank_at_first[along_curve[k]] = static_cast<unsigned int>(
      std::upper_bound(cuts_at_first.begin(), cuts_at_first.end(), begin + k) - cuts_at_first.begin() - 1);
}

template <int dim, int material_dim>
double Solid<dim, material_dim>::seconds_of_cell(const std::size_t cell) const
{
  const auto begin = points.seconds().begin() + std::ptrdiff_t(cell * n_points_per_cell());
  return std::accumulate(begin, begin + n_points_per_cell(), 0.0);
}

/// A round: every rank asks each of its points for something, and waits for the others.
template <int dim, int material_dim>
void Solid<dim, material_dim>::note_round()
{
  rounds.push_back(0.0);
  const std::size_t begin = rounds_at_first.size();
  rounds_at_first.resize(begin + cuts.size() - 1, 0.0);
  for (std::size_t cell = 0; cell < seconds_noted.size(); ++cell)
    {
      const double now = seconds_of_cell(cell);
      rounds.back() += now - seconds_noted[cell];
      rounds_at_first[begin + rank_at_first[cell]] += now - seconds_noted[cell];
      seconds_noted[cell] = now;
    }
}

template <int dim, int material_dim>
Balance Solid<dim, material_dim>::rebalance()
{
  const std::size_t n_ranks = cuts.size() - 1;
  Balance balance;
  balance.mean =
    Utilities::MPI::sum(std::accumulate(rounds.begin(), rounds.end(), 0.0), communicator()) / double(n_ranks);
  std::vector<double> longest_of_rounds(rounds.size());
  Utilities::MPI::max(rounds, communicator(), longest_of_rounds);
  balance.longest = std::accumulate(longest_of_rounds.begin(), longest_of_rounds.end(), 0.0);
  std::vector<double> of_ranks(rounds_at_first.size());
  Utilities::MPI::sum(rounds_at_first, communicator(), of_ranks);
  for (auto round = of_ranks.begin(); round != of_ranks.end(); round += std::ptrdiff_t(n_ranks))
    balance.longest_unmoved += *std::max_element(round, round + std::ptrdiff_t(n_ranks));
  rounds.clear();
  rounds_at_first.clear();

  std::vector<double> here;
  for (const std::size_t cell : along_curve)
    here.push_back(seconds_of_cell(cell));
  std::vector<double> everywhere;
  for (const auto& of_rank : Utilities::MPI::all_gather(communicator(), here))
    everywhere.insert(everywhere.end(), of_rank.begin(), of_rank.end());
  const auto weights = partition_weights(everywhere, n_ranks);
  const double longest = longest_share(everywhere, cuts);
  const double attainable = longest_share(everywhere, partition_cuts(weights, n_ranks));
  const auto n_threads = double(oneapi::tbb::this_task_arena::max_concurrency());
  // As with skis: rent until the rent has come to the price.
  constexpr double worth_while = 0.9;
  const bool pays = attainable < worth_while * longest && (longest - attainable) / n_threads > cost_of_moving;
  balance.moved = Utilities::MPI::max(int(pays), communicator()) == 1;
  if (balance.moved)
    {
      std::vector<unsigned int> weights_here(here.size());
      const std::size_t first = cuts[Utilities::MPI::this_mpi_process(communicator())];
      for (std::size_t k = 0; k < along_curve.size(); ++k)
        weights_here[along_curve[k]] = weights[first + k];
      const Timer timer;
      move_cells(weights_here);
      cost_of_moving = Utilities::MPI::max(timer.wall_time(), communicator());
    }
  return balance;
}

/// weights: of the cells of this rank.
template <int dim, int material_dim>
void Solid<dim, material_dim>::move_cells(const std::vector<unsigned int>& weights)
{
  const StoredSolid here = stored();
  std::map<std::uint64_t, std::size_t> index;
  for (std::size_t k = 0; k < here.cells.size(); ++k)
    index[here.cells[k].number] = k;

  auto& triangulation = *mesh.triangulation;
  const auto weigh = triangulation.signals.weight.connect(
    [&](const auto& cell, const auto /*status*/) { return weights[index.at(number_of(cell))]; });
  const auto handle = triangulation.register_data_attach(
    [&](const auto& cell, const auto /*status*/) {
      return Utilities::pack(here.cells[index.at(number_of(cell))], false);
    },
    true);
  triangulation.repartition();
  weigh.disconnect();
  std::vector<StoredCell> cells;
  triangulation.notify_ready_to_unpack(handle, [&](const auto&, const auto /*status*/, const auto& bytes) {
    cells.push_back(Utilities::unpack<StoredCell>(bytes.begin(), bytes.end(), false));
  });
  set_up();
  if (!take(cells))
    throw std::logic_error("a cell was lost on its way to another rank");
}

template <int dim, int material_dim>
double Solid<dim, material_dim>::reaction(const std::string& boundary, const unsigned int component) const
{
  double force = 0.0;
  for (const auto dof : DoFTools::extract_boundary_dofs(dof_handler, only<dim>(component), {mesh.boundary(boundary)}))
    if (owned.is_element(dof))
      force += accepted.internal_force(dof) - accepted.external_force(dof);
  return Utilities::MPI::sum(force, communicator());
}

/// Over a boundary, of a function of the displacement and the outer normal.
template <int dim, int material_dim>
template <typename Value>
double Solid<dim, material_dim>::integral(const std::string& boundary, const Vector& displacement,
                                          const Value& value) const
{
  const types::boundary_id wanted = mesh.boundary(boundary);
  FEFaceValues<dim> values(mapping, fe, face_quadrature,
                           update_values | update_normal_vectors | update_quadrature_points | update_JxW_values);
  const FEValuesExtractors::Vector displacements(0);
  std::vector<Tensor<1, dim>> u(face_quadrature.size());
  double sum = 0.0;
  for (const auto& cell : dof_handler.active_cell_iterators())
    if (cell->is_locally_owned())
      for (const auto& face : cell->face_iterators())
        if (face->at_boundary() && face->boundary_id() == wanted)
          {
            values.reinit(cell, face);
            values[displacements].get_function_values(displacement, u);
            for (const unsigned int q : values.quadrature_point_indices())
              sum += value(u[q], values.normal_vector(q)) * values.JxW(q) *
                     weight(parameters.kinematics, values.quadrature_point(q)[0]);
          }
  return Utilities::MPI::sum(sum, communicator());
}

template <int dim, int material_dim>
double Solid<dim, material_dim>::area(const std::string& boundary) const
{
  return integral(boundary, accepted.displacement, [](const auto&, const auto&) { return 1.0; });
}

template <int dim, int material_dim>
double Solid<dim, material_dim>::mean_displacement(const std::string& boundary, const unsigned int component) const
{
  return integral(boundary, accepted.displacement, [=](const auto& u, const auto&) { return u[component]; }) /
         area(boundary);
}

template <int dim, int material_dim>
double Solid<dim, material_dim>::swept_volume(const std::string& boundary) const
{
  return integral(boundary, accepted.displacement, [](const auto& u, const auto& normal) { return u * normal; });
}

namespace
{
template <int dim, typename Value>
Eigen::Matrix<double, n_components<dim>, 1> mean(const std::vector<double>& volumes, const Value& value,
                                                 const MPI_Comm communicator)
{
  Eigen::Matrix<double, n_components<dim>, 1> sum = Eigen::Matrix<double, n_components<dim>, 1>::Zero();
  double volume = 0.0;
  for (std::size_t i = 0; i < volumes.size(); ++i)
    {
      sum += volumes[i] * value(i);
      volume += volumes[i];
    }
  for (double& entry : sum)
    entry = Utilities::MPI::sum(entry, communicator);
  return sum / Utilities::MPI::sum(volume, communicator);
}
} // namespace

template <int dim, int material_dim>
StressVector<material_dim> Solid<dim, material_dim>::mean_stress() const
{
  return mean<material_dim>(
    point_volumes, [&](const std::size_t i) { return accepted.answers[i].stress; }, communicator());
}

template <int dim, int material_dim>
StrainVector<material_dim> Solid<dim, material_dim>::mean_strain() const
{
  return mean<material_dim>(
    point_volumes, [&](const std::size_t i) { return accepted.strains[i]; }, communicator());
}

template class Solid<2, 2>;
template class Solid<2, 3>;
template class Solid<3, 3>;
} // namespace feldspar::fem

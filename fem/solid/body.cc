#include "fem/solid/body.h"

#include <deal.II/base/mpi.h>
#include <deal.II/base/quadrature_lib.h>
#include <deal.II/dofs/dof_tools.h>
#include <deal.II/fe/fe_values.h>
#include <deal.II/lac/dynamic_sparsity_pattern.h>
#include <deal.II/lac/full_matrix.h>
#include <deal.II/lac/sparsity_tools.h>

#include <boost/serialization/string.hpp>
#include <boost/serialization/vector.hpp>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <numeric>
#include <stdexcept>
#include <utility>

namespace feldspar::fem
{
using namespace dealii;

namespace
{
/// PointPlace::side_normal.
template <int dim, typename Cell>
std::vector<double> side_normal(const Discretisation<dim>& elements, const Cell& cell)
{
  FEFaceValues<dim> values(elements.mapping, elements.fe, QMidpoint<dim - 1>(), update_normal_vectors);
  for (const unsigned int face : cell->face_indices())
    {
      const auto& boundaries = elements.mesh.boundaries;
      const auto is_no_side = [&](const auto& boundary) {
        return boundary.second == cell->face(face)->boundary_id() &&
               (boundary.first == "bottom" || boundary.first == "top" || boundary.first == "axis");
      };
      if (!cell->face(face)->at_boundary() || std::ranges::any_of(boundaries, is_no_side))
        continue;
      values.reinit(cell, face);
      const Tensor<1, dim>& normal = values.normal_vector(0);
      return {normal.begin_raw(), normal.end_raw()};
    }
  return {};
}

template <int dim>
double pressure_on(const types::boundary_id boundary, const std::map<std::string, double>& pressures,
                   const SampleMesh<dim>& mesh)
{
  double pressure = 0.0;
  for (const auto& [name, value] : pressures)
    if (mesh.boundary(name) == boundary)
      pressure += value;
  return pressure;
}

void check_everywhere(const bool fits, const MPI_Comm communicator)
{
  if (Utilities::MPI::min(int(fits), communicator) == 0)
    throw std::invalid_argument("the state of another mesh");
}
} // namespace

template <int dim, int material_dim>
void SolidBody<dim, material_dim>::make_points(const Material<material_dim>& material)
{
  materials = {}; // the old ones go before the new ones come: both need not fit into memory
  places.clear();
  volumes.clear();
  FEValues<dim> values(elements.mapping, elements.fe, elements.quadrature,
                       update_quadrature_points | update_JxW_values);
  for (const auto& cell : elements.owned_cells())
    {
      values.reinit(cell);
      const std::vector<double> normal = side_normal(elements, cell);
      const double measure = std::accumulate(values.get_JxW_values().begin(), values.get_JxW_values().end(), 0.0);
      for (const unsigned int q : values.quadrature_point_indices())
        {
          const Point<dim>& position = values.quadrature_point(q);
          PointPlace place{
            cell->id().to_string(), number_of(cell), q, {}, std::pow(measure, 1.0 / dim) / elements.order, normal};
          for (unsigned int component = 0; component < dim; ++component)
            place.position.push_back(position[component]);
          materials.add(material.make_point(place));
          places.push_back(std::move(place));
          volumes.push_back(values.JxW(q) * weight(elements.kinematics, position[0]));
        }
    }
}

template <int dim, int material_dim>
auto SolidBody<dim, material_dim>::at_rest() const -> State
{
  State state{elements.ghosted_vector(), elements.owned_vector(), elements.owned_vector(), {}, {}};
  state.strains.assign(materials.size(), StrainVector<material_dim>::Zero());
  state.responses = materials.trial(state.strains);
  return state;
}

template <int dim, int material_dim>
std::vector<StrainVector<material_dim>> SolidBody<dim, material_dim>::strains_of(const NodalVector& displacement) const
{
  FEValues<dim> values(elements.mapping, elements.fe, elements.quadrature,
                       update_values | update_gradients | update_quadrature_points);
  const FEValuesExtractors::Vector displacements(0);
  std::vector<Tensor<1, dim>> u(elements.quadrature.size());
  std::vector<Tensor<2, dim>> gradients(elements.quadrature.size());
  std::vector<StrainVector<material_dim>> strains;
  for (const auto& cell : elements.owned_cells())
    {
      values.reinit(cell);
      values[displacements].get_function_values(displacement, u);
      values[displacements].get_function_gradients(displacement, gradients);
      for (const unsigned int q : values.quadrature_point_indices())
        {
          StrainVector<material_dim> strain = StrainVector<material_dim>::Zero();
          for (unsigned int component = 0; component < dim; ++component)
            strain += strain_of<dim, material_dim>(elements.kinematics, component, u[q][component],
                                                   gradients[q][component], values.quadrature_point(q)[0]);
          strains.push_back(strain);
        }
    }
  return strains;
}

template <int dim, int material_dim>
NodalForces SolidBody<dim, material_dim>::forces(const State& state, const Constraints& constraints) const
{
  const auto& fe = elements.fe;
  FEValues<dim> values(elements.mapping, fe, elements.quadrature,
                       update_values | update_gradients | update_quadrature_points);
  FEFaceValues<dim> face_values(elements.mapping, fe, elements.face_quadrature,
                                update_values | update_normal_vectors | update_quadrature_points | update_JxW_values);
  const unsigned int n_dofs = fe.n_dofs_per_cell();
  Vector<double> internal(n_dofs);
  Vector<double> external(n_dofs);
  std::vector<types::global_dof_index> dofs(n_dofs);
  NodalForces sums{elements.owned_vector(), elements.owned_vector(), elements.owned_vector()};
  std::size_t point = 0;
  for (const auto& cell : elements.owned_cells())
    {
      values.reinit(cell);
      internal = 0.0;
      external = 0.0;
      for (const unsigned int q : values.quadrature_point_indices())
        {
          const double radius = values.quadrature_point(q)[0];
          for (const unsigned int i : values.dof_indices())
            internal[i] += strain_of<dim, material_dim>(elements.kinematics, fe.system_to_component_index(i).first,
                                                        values.shape_value(i, q), values.shape_grad(i, q), radius)
                             .dot(state.responses[point].stress) *
                           volumes[point];
          ++point;
        }
      for (const auto& face : cell->face_iterators())
        if (face->at_boundary())
          if (const double pressure = pressure_on(face->boundary_id(), state.pressures, elements.mesh); pressure != 0.0)
            {
              face_values.reinit(cell, face);
              for (const unsigned int q : face_values.quadrature_point_indices())
                for (const unsigned int i : face_values.dof_indices())
                  external[i] -= pressure * face_values.normal_vector(q)[fe.system_to_component_index(i).first] *
                                 face_values.shape_value(i, q) * face_values.JxW(q) *
                                 weight(elements.kinematics, face_values.quadrature_point(q)[0]);
            }
      cell->get_dof_indices(dofs);
      sums.internal.add(dofs, internal);
      sums.external.add(dofs, external);
      external -= internal;
      constraints.distribute_local_to_global(external, dofs, sums.unbalanced);
    }
  for (NodalVector* const sum : {&sums.internal, &sums.external, &sums.unbalanced})
    sum->compress(VectorOperation::add);
  return sums;
}

template <int dim, int material_dim>
void SolidBody<dim, material_dim>::set_pattern(Matrix& matrix, const Constraints& constraints) const
{
  // A free plate ties nodes to one that may be of another rank.
  IndexSet rows = elements.relevant;
  for (const auto& line : constraints.get_lines())
    for (const auto& entry : line.entries)
      rows.add_index(entry.first);
  const auto n_dofs = elements.dof_handler.n_dofs();
  DynamicSparsityPattern pattern(n_dofs, n_dofs, rows);
  DoFTools::make_sparsity_pattern(elements.dof_handler, pattern, constraints, false);
  SparsityTools::distribute_sparsity_pattern(pattern, elements.owned, elements.communicator(), rows);
  matrix.reinit(elements.owned, elements.owned, pattern, elements.communicator());
}

template <int dim, int material_dim>
void SolidBody<dim, material_dim>::assemble_tangent(const State& state, const Constraints& constraints, Matrix& matrix,
                                                    NodalVector& right_side) const
{
  const auto& fe = elements.fe;
  FEValues<dim> values(elements.mapping, fe, elements.quadrature,
                       update_values | update_gradients | update_quadrature_points);
  const unsigned int n_dofs = fe.n_dofs_per_cell();
  FullMatrix<double> cell_matrix(n_dofs, n_dofs);
  Vector<double> no_force(n_dofs);
  Eigen::Matrix<double, n_voigt<material_dim>, Eigen::Dynamic> B(n_voigt<material_dim>, n_dofs);
  Eigen::MatrixXd stiffness(n_dofs, n_dofs);
  std::vector<types::global_dof_index> dofs(n_dofs);
  matrix = 0.0;
  std::size_t point = 0;
  for (const auto& cell : elements.owned_cells())
    {
      values.reinit(cell);
      stiffness.setZero();
      for (const unsigned int q : values.quadrature_point_indices())
        {
          const double radius = values.quadrature_point(q)[0];
          for (const unsigned int i : values.dof_indices())
            B.col(i) = strain_of<dim, material_dim>(elements.kinematics, fe.system_to_component_index(i).first,
                                                    values.shape_value(i, q), values.shape_grad(i, q), radius);
          stiffness.noalias() += B.transpose() * (state.responses[point].tangent * B) * volumes[point];
          ++point;
        }
      for (const unsigned int i : values.dof_indices())
        for (const unsigned int j : values.dof_indices())
          cell_matrix(i, j) = stiffness(i, j);
      cell->get_dof_indices(dofs);
      constraints.distribute_local_to_global(cell_matrix, no_force, dofs, matrix, right_side);
    }
  matrix.compress(VectorOperation::add);
  right_side.compress(VectorOperation::add);
}

template <int dim, int material_dim>
std::vector<StoredCell> SolidBody<dim, material_dim>::stored_cells(const State& state) const
{
  std::vector<StoredCell> cells;
  std::vector<types::global_dof_index> dofs(elements.fe.n_dofs_per_cell());
  std::size_t point = 0;
  for (const auto& cell : elements.owned_cells())
    {
      StoredCell stored{number_of(cell), {}, {}, {}};
      cell->get_dof_indices(dofs);
      for (const auto dof : dofs)
        stored.displacement.push_back(state.displacement(dof));
      for (unsigned int q = 0; q < elements.n_points_per_cell(); ++q, ++point)
        {
          const auto& [stress, tangent] = state.responses[point];
          stored.responses.insert(stored.responses.end(), stress.begin(), stress.end());
          stored.responses.insert(stored.responses.end(), tangent.data(), tangent.data() + tangent.size());
          stored.points.push_back(materials[point].stored());
        }
      cells.push_back(std::move(stored));
    }
  return cells;
}

template <int dim, int material_dim>
std::vector<StoredCell> SolidBody<dim, material_dim>::brought_home(const std::vector<StoredCell>& cells) const
{
  const std::uint64_t n_cells = elements.n_cells();
  check_everywhere(std::ranges::all_of(cells, [=](const StoredCell& cell) { return cell.number < n_cells; }),
                   elements.communicator());
  IndexSet at_home(n_cells);
  IndexSet brought(n_cells);
  for (const auto& cell : elements.owned_cells())
    at_home.add_index(number_of(cell));
  for (const StoredCell& cell : cells)
    brought.add_index(cell.number);
  const auto owners = Utilities::MPI::compute_index_owner(at_home, brought, elements.communicator());
  std::map<unsigned int, std::vector<StoredCell>> sent;
  for (const StoredCell& cell : cells)
    sent[owners[brought.index_within_set(cell.number)]].push_back(cell);
  std::vector<StoredCell> result;
  for (auto& [rank, received] : Utilities::MPI::some_to_some(elements.communicator(), sent))
    result.insert(result.end(), std::make_move_iterator(received.begin()), std::make_move_iterator(received.end()));
  return result;
}

template <int dim, int material_dim>
auto SolidBody<dim, material_dim>::restored(const State& rest, const std::vector<StoredCell>& cells) -> State
{
  constexpr std::size_t n = n_voigt<material_dim>;
  const std::size_t n_of_cell = elements.n_points_per_cell();
  std::map<std::uint64_t, const StoredCell*> by_number;
  bool whole = true;
  for (const StoredCell& cell : cells)
    whole = by_number.emplace(cell.number, &cell).second && cell.displacement.size() == elements.fe.n_dofs_per_cell() &&
            cell.responses.size() == (n + n * n) * n_of_cell && cell.points.size() == n_of_cell && whole;
  for (const PointPlace& place : places)
    whole = whole && by_number.contains(place.cell_number);
  check_everywhere(whole, elements.communicator());

  State state = rest;
  NodalVector displacement = elements.owned_vector();
  std::vector<types::global_dof_index> dofs(elements.fe.n_dofs_per_cell());
  std::vector<std::string> stored_points;
  for (const auto& cell : elements.owned_cells())
    {
      const StoredCell& stored = *by_number.at(number_of(cell));
      cell->get_dof_indices(dofs);
      for (std::size_t i = 0; i < dofs.size(); ++i)
        if (elements.owned.is_element(dofs[i]))
          displacement(dofs[i]) = stored.displacement[i];
      for (std::size_t q = 0; q < n_of_cell; ++q)
        {
          const double* const response = &stored.responses[q * (n + n * n)];
          auto& [stress, tangent] = state.responses[stored_points.size()];
          std::copy_n(response, n, stress.data());
          std::copy_n(response + n, n * n, tangent.data());
          stored_points.push_back(stored.points[q]);
        }
    }
  displacement.compress(VectorOperation::insert);
  state.displacement = displacement;
  state.strains = strains_of(state.displacement);
  bool understood = true;
  try
    {
      materials.restore(stored_points);
    }
  catch (const std::exception&)
    {
      understood = false;
    }
  check_everywhere(understood, elements.communicator());
  return state;
}

template struct SolidBody<2, 2>;
template struct SolidBody<2, 3>;
template struct SolidBody<3, 3>;
} // namespace feldspar::fem

#include "fem/solid/stored_solid.h"

#include <deal.II/base/mpi.h>

#include <boost/serialization/string.hpp>
#include <boost/serialization/vector.hpp>

#include <algorithm>
#include <iterator>
#include <stdexcept>
#include <utility>

namespace feldspar::fem
{
using namespace dealii;

template <int dim, int material_dim>
std::vector<StoredCell> stored_cells(const Discretisation<dim>& elements, const MaterialPoints<material_dim>& materials,
                                     const SolidState<material_dim>& state)
{
  std::vector<StoredCell> cells;
  std::vector<types::global_dof_index> dofs(elements.fe.n_dofs_per_cell());
  std::size_t point = 0;
  for (const auto& cell : elements.dof_handler.active_cell_iterators())
    if (cell->is_locally_owned())
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

template <int dim>
std::vector<StoredCell> brought_home(const Discretisation<dim>& elements, const std::vector<StoredCell>& cells)
{
  const std::uint64_t n_cells = elements.n_cells();
  const bool known = std::ranges::all_of(cells, [=](const StoredCell& cell) { return cell.number < n_cells; });
  if (Utilities::MPI::min(int(known), elements.communicator()) == 0)
    throw std::invalid_argument("the state of another mesh");
  IndexSet at_home(n_cells);
  IndexSet brought(n_cells);
  for (const auto& cell : elements.dof_handler.active_cell_iterators())
    if (cell->is_locally_owned())
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

namespace
{
void check_everywhere(const bool fits, const MPI_Comm communicator)
{
  if (Utilities::MPI::min(int(fits), communicator) == 0)
    throw std::invalid_argument("the state of another mesh");
}
} // namespace

template <int dim, int material_dim>
SolidState<material_dim> restored(const Discretisation<dim>& elements, SolidPoints<material_dim>& points,
                                  const SolidState<material_dim>& at_rest, const std::vector<StoredCell>& cells)
{
  constexpr std::size_t n = n_voigt<material_dim>;
  const std::size_t n_of_cell = elements.n_points_per_cell();
  std::map<std::uint64_t, const StoredCell*> by_number;
  bool whole = true;
  for (const StoredCell& cell : cells)
    whole = by_number.emplace(cell.number, &cell).second && cell.displacement.size() == elements.fe.n_dofs_per_cell() &&
            cell.responses.size() == (n + n * n) * n_of_cell && cell.points.size() == n_of_cell && whole;
  for (const PointPlace& place : points.places)
    whole = whole && by_number.count(place.cell_number) == 1;
  check_everywhere(whole, elements.communicator());

  SolidState<material_dim> state = at_rest;
  NodalVector displacement = elements.owned_vector();
  std::vector<types::global_dof_index> dofs(elements.fe.n_dofs_per_cell());
  std::vector<std::string> stored_points;
  for (const auto& cell : elements.dof_handler.active_cell_iterators())
    if (cell->is_locally_owned())
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
  state.strains = strains_of<dim, material_dim>(elements, state.displacement);
  bool understood = true;
  try
    {
      points.materials.restore(stored_points);
    }
  catch (const std::exception&)
    {
      understood = false;
    }
  check_everywhere(understood, elements.communicator());
  return state;
}

template std::vector<StoredCell> stored_cells(const Discretisation<2>&, const MaterialPoints<2>&, const SolidState<2>&);
template std::vector<StoredCell> stored_cells(const Discretisation<2>&, const MaterialPoints<3>&, const SolidState<3>&);
template std::vector<StoredCell> stored_cells(const Discretisation<3>&, const MaterialPoints<3>&, const SolidState<3>&);
template std::vector<StoredCell> brought_home(const Discretisation<2>&, const std::vector<StoredCell>&);
template std::vector<StoredCell> brought_home(const Discretisation<3>&, const std::vector<StoredCell>&);
template SolidState<2> restored(const Discretisation<2>&, SolidPoints<2>&, const SolidState<2>&,
                                const std::vector<StoredCell>&);
template SolidState<3> restored(const Discretisation<2>&, SolidPoints<3>&, const SolidState<3>&,
                                const std::vector<StoredCell>&);
template SolidState<3> restored(const Discretisation<3>&, SolidPoints<3>&, const SolidState<3>&,
                                const std::vector<StoredCell>&);
} // namespace feldspar::fem

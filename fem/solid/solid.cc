#include "fem/solid/solid.h"

#include "fem/solid/newton.h"

#include <deal.II/base/mpi.h>
#include <deal.II/base/timer.h>

#include <boost/serialization/string.hpp>
#include <boost/serialization/vector.hpp>

#include <map>
#include <numeric>
#include <utility>

namespace feldspar::fem
{
using namespace dealii;

template <int dim, int material_dim>
Solid<dim, material_dim>::Solid(const SampleMesh<dim>& mesh, const SolidParameters& its_parameters,
                                const Material<material_dim>& its_material)
  : parameters(its_parameters)
  , material(its_material)
  , body(mesh, parameters)
{
  set_up();
}

/// The state of this rank's cells, at rest.
template <int dim, int material_dim>
void Solid<dim, material_dim>::set_up()
{
  balance.place(body.elements);
  matrix.clear();
  tried.reset();
  accepted.reset();
  body.make_points(material);
  accepted.emplace(body.at_rest());
}

template <int dim, int material_dim>
NewtonReport Solid<dim, material_dim>::solve(const Load<dim>& load, const double fraction)
{
  reject();
  SolidConstraints constraints = constrain(body.elements, load, accepted->displacement, fraction);
  if (constraints.places != places_of_matrix || matrix.m() == 0)
    {
      body.set_pattern(matrix, constraints.standing);
      places_of_matrix = constraints.places;
    }
  SolidState<material_dim> start = *accepted;
  // Pressures that the new load does not name go to zero.
  for (auto& [boundary, pressure] : start.pressures)
    pressure *= 1.0 - fraction;
  for (const auto& pressure : load.pressures)
    {
      body.elements.mesh.boundary(pressure.boundary);
      start.pressures[pressure.boundary] += fraction * pressure.value;
    }
  auto found = find_equilibrium(
    body, parameters, matrix, [this] { note_round(); }, std::move(constraints), start);
  tried.emplace(std::move(found.state));
  return std::move(found.report);
}

template <int dim, int material_dim>
void Solid<dim, material_dim>::accept()
{
  body.materials.accept(tried->strains);
  note_round();
  accepted = tried;
}

template <int dim, int material_dim>
void Solid<dim, material_dim>::reject()
{
  body.materials.reject();
}

template <int dim, int material_dim>
StoredSolid Solid<dim, material_dim>::stored() const
{
  return {body.stored_cells(*accepted), accepted->pressures, accepted->work};
}

template <int dim, int material_dim>
void Solid<dim, material_dim>::restore(const StoredSolid& stored)
{
  accepted->pressures = stored.pressures;
  accepted->work = stored.work;
  take(body.brought_home(stored.cells));
}

/// Makes these the accepted state of the cells of this rank.
template <int dim, int material_dim>
void Solid<dim, material_dim>::take(const std::vector<StoredCell>& cells)
{
  accepted = body.restored(*accepted, cells);
  const NodalForces forces = body.forces(*accepted);
  accepted->internal_force = forces.internal;
  accepted->external_force = forces.external;
}

template <int dim, int material_dim>
void Solid<dim, material_dim>::note_round()
{
  const std::vector<double>& of_points = body.materials.seconds();
  std::vector<double> of_cells;
  for (auto point = of_points.begin(); point != of_points.end(); point += n_points_per_cell())
    of_cells.push_back(std::accumulate(point, point + n_points_per_cell(), 0.0));
  balance.note_round(of_cells);
}

template <int dim, int material_dim>
Balance Solid<dim, material_dim>::rebalance()
{
  const auto verdict = balance.strike(communicator());
  if (verdict.balance.moved)
    {
      const Timer timer;
      const StoredSolid here = stored();
      const std::vector<StoredCell> cells = moved(here.cells, verdict.weights);
      body.elements.distribute();
      set_up();
      accepted->pressures = here.pressures;
      accepted->work = here.work;
      take(cells);
      balance.note_move(Utilities::MPI::max(timer.wall_time(), communicator()));
    }
  return verdict.balance;
}

/// The cells that are this rank's once the mesh has been distributed by these weights.
template <int dim, int material_dim>
std::vector<StoredCell> Solid<dim, material_dim>::moved(const std::vector<StoredCell>& cells,
                                                        const std::vector<unsigned int>& weights)
{
  std::map<std::uint64_t, std::size_t> index;
  for (std::size_t k = 0; k < cells.size(); ++k)
    index[cells[k].number] = k;

  auto& triangulation = *body.elements.mesh.triangulation;
  const auto weigh = triangulation.signals.weight.connect(
    [&](const auto& cell, const auto /*status*/) { return weights[index.at(number_of(cell))]; });
  const auto handle = triangulation.register_data_attach(
    [&](const auto& cell, const auto /*status*/) { return Utilities::pack(cells[index.at(number_of(cell))], false); },
    true);
  triangulation.repartition();
  weigh.disconnect();
  std::vector<StoredCell> here;
  triangulation.notify_ready_to_unpack(handle, [&](const auto&, const auto /*status*/, const auto& bytes) {
    here.push_back(Utilities::unpack<StoredCell>(bytes.begin(), bytes.end(), false));
  });
  return here;
}

template <int dim, int material_dim>
double Solid<dim, material_dim>::reaction(const std::string& boundary, const unsigned int component) const
{
  double force = 0.0;
  for (const auto dof : body.elements.dofs_on(boundary, component))
    if (body.elements.owned.is_element(dof))
      force += accepted->internal_force(dof) - accepted->external_force(dof);
  return Utilities::MPI::sum(force, communicator());
}

template <int dim, int material_dim>
double Solid<dim, material_dim>::pressure(const std::string& boundary) const
{
  const auto found = accepted->pressures.find(boundary);
  return found == accepted->pressures.end() ? 0.0 : found->second;
}

template <int dim, int material_dim>
void Solid<dim, material_dim>::bear_by_pressure(const std::string& boundary, const unsigned int component)
{
  // The boundary faces upwards: its pressure acts against the coordinate.
  accepted->pressures[boundary] -= reaction(boundary, component) / area(boundary);
  accepted->external_force = body.forces(*accepted).external;
}

template <int dim, int material_dim>
double Solid<dim, material_dim>::area(const std::string& boundary) const
{
  return body.elements.integral(boundary, displacement(), [](const auto&, const auto&) { return 1.0; });
}

template <int dim, int material_dim>
double Solid<dim, material_dim>::mean_displacement(const std::string& boundary, const unsigned int component) const
{
  return body.elements.integral(boundary, displacement(), [=](const auto& u, const auto&) { return u[component]; }) /
         area(boundary);
}

template <int dim, int material_dim>
double Solid<dim, material_dim>::swept_volume(const std::string& boundary) const
{
  return body.elements.swept_volume({boundary}, displacement());
}

namespace
{
template <int dim, typename Value>
Voigt<dim> mean(const std::vector<double>& volumes, const Value& value, const MPI_Comm communicator)
{
  Voigt<dim> sum = Voigt<dim>::Zero();
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
    volumes(), [&](const std::size_t i) { return responses()[i].stress; }, communicator());
}

template <int dim, int material_dim>
StrainVector<material_dim> Solid<dim, material_dim>::mean_strain() const
{
  return mean<material_dim>(
    volumes(), [&](const std::size_t i) { return strains()[i]; }, communicator());
}

template class Solid<2, 2>;
template class Solid<2, 3>;
template class Solid<3, 3>;
} // namespace feldspar::fem

#pragma once

#include "fem/solid/body.h"
#include "fem/solid/cell_balance.h"
#include "fem/solid/load.h"
#include "fem/solid/parameters.h"

#include <cstddef>
#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <vector>

namespace feldspar::fem
{
/// The accepted state of a solid, for a file that returns to the same program and mesh.
struct StoredSolid
{
  std::vector<StoredCell> cells;           ///< of this rank
  std::map<std::string, double> pressures; ///< the same on every rank
  BoundaryWork work{};                     ///< the same on every rank
};

/// A body in quasi-static equilibrium, at small strain; docs/theory.md §8.
///
/// solve() looks for equilibrium under a load, from the accepted state; accept() makes it the accepted state. Every
/// query is about the accepted state, and of the whole body unless it says that it is of this rank.
template <int dim, int material_dim = dim>
class Solid
{
public:
  /// The mesh must outlive the solid, which moves its cells between ranks.
  Solid(const SampleMesh<dim>& mesh, const SolidParameters& parameters, const Material<material_dim>& material);

  /// Goes this fraction of the way from the accepted state to the load. Collective, as everything below but const
  /// access to points. Throws MeshError for a boundary that is not there.
  NewtonReport solve(const Load<dim>& load, double fraction = 1.0);
  void accept();
  void reject();

  /// The state of the cells of this rank.
  StoredSolid stored() const;
  /// Restores each cell from whatever rank brings it. Throws std::invalid_argument, on every rank, where it is of
  /// another mesh; the solid is then unusable.
  void restore(const StoredSolid& stored);

  /// Distributes the cells to the ranks anew, by the time each took, if the loss of the present distribution would have
  /// paid for it. Data of this rank then belong to other points. Not to be called between solve() and accept() or
  /// reject().
  Balance rebalance();

  /// Limits the events, from the next solve on.
  void limit_events(const std::uint64_t most_events) { parameters.most_events = most_events; }

  /// Pressure against a boundary [Pa]; zero where none has been applied.
  double pressure(const std::string& boundary) const;

  /// Turns the force that holds a displacement of a boundary into a pressure on it, so that a free plate may take over
  /// from where the solid stands. Collective.
  void bear_by_pressure(const std::string& boundary, unsigned int component);

  /// Force on the body along a coordinate by what holds a boundary's displacement [N], without its own pressure. In
  /// the plane per metre of thickness; in r-z around the whole circle.
  double reaction(const std::string& boundary, unsigned int component) const;

  /// Work on the way from rest to here.
  const BoundaryWork& boundary_work() const { return accepted->work; }

  /// Mean over the boundary [m].
  double mean_displacement(const std::string& boundary, unsigned int component) const;
  /// Volume between the boundary at rest and as it is displaced, outwards positive [m³].
  double swept_volume(const std::string& boundary) const;

  /// The area of a boundary [m²].
  double area(const std::string& boundary) const;

  /// Mean over the volume.
  StressVector<material_dim> mean_stress() const;
  StrainVector<material_dim> mean_strain() const;

  const NodalVector& displacement() const { return accepted->displacement; } ///< with ghosts
  const dealii::DoFHandler<dim>& dofs() const { return body.elements.dof_handler; }
  const dealii::Mapping<dim>& geometry() const { return body.elements.mapping; }
  Kinematics kinematics() const { return parameters.kinematics; }
  const std::vector<std::string>& field_names() const { return material.field_names; }
  MPI_Comm communicator() const { return body.elements.communicator(); }

  /// Number of points on all ranks.
  std::uint64_t n_points() const { return body.elements.n_cells() * n_points_per_cell(); }

  // The points of this rank, in the order of its cells, n_points_per_cell() each.
  unsigned int n_points_per_cell() const { return body.elements.n_points_per_cell(); }
  const MaterialPoints<material_dim>& material_points() const { return body.materials; }
  /// Number of a point among all points; the same for any number of ranks.
  std::uint64_t number_of_point(const std::size_t i) const
  {
    return places()[i].cell_number * n_points_per_cell() + places()[i].quadrature_point;
  }
  const std::vector<PointPlace>& places() const { return body.places; }
  const std::vector<double>& volumes() const { return body.volumes; } ///< [m³]
  const std::vector<StrainVector<material_dim>>& strains() const { return accepted->strains; }
  const std::vector<MaterialResponse<material_dim>>& responses() const { return accepted->responses; }
  /// Fall of the stress by the events of the last step, each at a held strain [Pa].
  const std::vector<StressVector<material_dim>>& stress_drops() const { return accepted->stress_drops; }

private:
  void set_up();
  void take(const std::vector<StoredCell>& cells);
  void note_round();
  std::vector<StoredCell> moved(const std::vector<StoredCell>& cells, const std::vector<unsigned int>& weights);

  SolidParameters parameters;
  Material<material_dim> material;
  SolidBody<dim, material_dim> body;
  CellBalance<dim> balance;

  /// State made anew, never assigned, where cells move: PETSc assigns only where ranks have as many entries of both.
  std::optional<SolidState<material_dim>> accepted;
  std::optional<SolidState<material_dim>> tried; ///< since the last solve()

  dealii::PETScWrappers::MPI::SparseMatrix matrix;
  std::string places_of_matrix; ///< SolidConstraints::places it was set up for
};
} // namespace feldspar::fem

#pragma once

#include "fem/solid/boundary_work.h"
#include "fem/solid/discretisation.h"
#include "fem/solid/material_points.h"

#include <deal.II/lac/affine_constraints.h>
#include <deal.II/lac/petsc_sparse_matrix.h>

#include <cstdint>
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
    stress_drops{};                          ///< by the events of the last step, each at a held strain [Pa]
  std::map<std::string, double> pressures{}; ///< on boundaries by their names [Pa]
  BoundaryWork work{};                       ///< on the way here from rest, the same on every rank
};

/// The accepted state of a cell; the same for any number of ranks.
struct StoredCell
{
  std::uint64_t number;             ///< PointPlace::cell_number
  std::vector<double> displacement; ///< of its degrees of freedom, in the order of its element
  std::vector<double> responses;    ///< of its points one after another: stress, then tangent
  std::vector<std::string> points;  ///< MaterialPoint::stored()

  template <typename Archive>
  void serialize(Archive& archive, unsigned int /*version*/)
  {
    archive& number& displacement& responses& points;
  }
};

/// Forces on every node [N].
struct NodalForces
{
  NodalVector internal;   ///< by the stresses, as if nothing were held
  NodalVector external;   ///< of the pressures
  NodalVector unbalanced; ///< external less internal, on what the constraints leave free to move
};

/// Finite elements with a material in their points: the weak form of equilibrium and its derivative by the displacement,
/// docs/theory.md §8.1. It holds no state of the nodes.
template <int dim, int material_dim>
struct SolidBody
{
  using State = SolidState<material_dim>;
  using Constraints = dealii::AffineConstraints<double>;
  using Matrix = dealii::PETScWrappers::MPI::SparseMatrix;

  /// Without points. The mesh must outlive it.
  SolidBody(const SampleMesh<dim>& mesh, const SolidParameters& parameters)
    : elements(mesh, parameters)
  {
  }

  /// Makes the points of the cells that this rank has now.
  void make_points(const Material<material_dim>& material);

  /// State at rest, with the responses of the points to no strain. Collective.
  State at_rest() const;

  /// The strain at each point of this rank.
  std::vector<StrainVector<material_dim>> strains_of(const NodalVector& displacement) const;

  /// The forces of a state's stresses and pressures. Collective.
  NodalForces forces(const State& state, const Constraints& constraints = Constraints()) const;

  /// The pattern of the matrix under such constraints. Collective.
  void set_pattern(Matrix& matrix, const Constraints& constraints) const;

  /// The matrix of the tangents; adds to the right side the motion that the constraints ask for. Collective.
  void assemble_tangent(const State& state, const Constraints& constraints, Matrix& matrix,
                        NodalVector& right_side) const;

  /// Cells of this rank, as they are stored.
  std::vector<StoredCell> stored_cells(const State& state) const;

  /// The cells of this rank among those that all ranks bring. Collective.
  std::vector<StoredCell> brought_home(const std::vector<StoredCell>& cells) const;

  /// The state at rest with displacement, strains and responses of the cells of this rank, and the points put back to theirs;
  /// forces and pressures stay. Collective. Throws std::invalid_argument, on every rank, where these are not all cells, or
  /// of another mesh or material; the points are then unusable.
  State restored(const State& rest, const std::vector<StoredCell>& cells);

  Discretisation<dim> elements;
  // The quadrature points of this rank, in the order of its cells.
  MaterialPoints<material_dim> materials;
  std::vector<PointPlace> places;
  std::vector<double> volumes; ///< [m³]
};
} // namespace feldspar::fem

#pragma once

#include "fem/mesh/sample_mesh.h"
#include "fem/solid/kinematics.h"
#include "fem/solid/linear_solver.h"
#include "fem/solid/load.h"
#include "fem/solid/material_points.h"

#include <deal.II/base/quadrature.h>
#include <deal.II/dofs/dof_handler.h>
#include <deal.II/fe/fe_system.h>
#include <deal.II/fe/mapping_q.h>
#include <deal.II/lac/affine_constraints.h>
#include <deal.II/lac/petsc_sparse_matrix.h>
#include <deal.II/lac/petsc_vector.h>

#include <cstddef>
#include <cstdint>
#include <functional>
#include <limits>
#include <map>
#include <string>
#include <vector>

namespace feldspar::fem
{
/// How a solve went.
struct NewtonReport
{
  bool converged = false;
  std::string failure;           ///< why not; empty if it converged
  unsigned int n_iterations = 0; ///< linear systems solved
  unsigned int n_cascades = 0;   ///< times that points changed their structure and equilibrium was sought anew
  std::uint64_t n_events = 0;    ///< of all points and cascades
  std::vector<double> residuals; ///< unbalanced over internal force, before each iteration and at the end
};

struct SolidParameters
{
  Kinematics kinematics = Kinematics::plane;
  unsigned int order = 1;          ///< of the shape functions, 1 or 2
  bool reduced_quadrature = false; ///< order instead of order + 1 points a direction; order 2 only
  LinearSolver linear_solver = LinearSolver::automatic;
  double linear_tolerance = 1e-12;   ///< residual over right side; that of a moved boundary is large beside the forces
  double newton_tolerance = 1e-9;    ///< unbalanced over internal force, both as Euclidean norms
  unsigned int most_iterations = 15; ///< between two cascades
  unsigned int most_cascades = 1000;
  std::uint64_t most_events = std::numeric_limits<std::uint64_t>::max(); ///< in one solve
  /// Called after each iteration and cascade, on every rank. What it throws ends the solve; the accepted state stays.
  std::function<void(const NewtonReport&)> watch = [](const NewtonReport&) {};
};

/// The accepted state of a cell; the same for any number of ranks.
struct StoredCell
{
  std::uint64_t number;             ///< PointPlace::cell_number
  std::vector<double> displacement; ///< of its degrees of freedom, in the order of its element
  std::vector<double> answers;      ///< of its points one after another: stress, then tangent
  std::vector<std::string> points;  ///< MaterialPoint::stored()

  template <typename Archive>
  void serialize(Archive& archive, unsigned int /*version*/)
  {
    archive& number& displacement& answers& points;
  }
};

/// The accepted state of a solid, for a file that returns to the same program and mesh.
struct StoredSolid
{
  std::vector<StoredCell> cells;           ///< of this rank
  std::map<std::string, double> pressures; ///< the same on every rank
};

/// How long ranks were at work in their points since rebalance() was last called, on one core each [s].
struct Balance
{
  double mean = 0.0;
  double longest = 0.0;         ///< sum of the longest of each round, for which the others wait
  double longest_unmoved = 0.0; ///< the same had the cells never moved
  bool moved = false;           ///< now
};

/// A body in quasi-static equilibrium, at small strain; docs/theory.md §9.
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

  /// Of the cells of this rank.
  StoredSolid stored() const;
  /// Each cell from whatever rank brings it. Throws std::invalid_argument, on every rank, where it is of another mesh;
  /// the solid is then unusable.
  void restore(const StoredSolid& stored);

  /// Deals the cells out to the ranks anew, by the time each took, if what the present deal has lost would have paid for
  /// it. What is of this rank is then of other points. Not between solve() and accept() or reject().
  Balance rebalance();

  /// From the next solve on.
  void limit_events(const std::uint64_t most_events) { parameters.most_events = most_events; }

  /// Force on the body along a coordinate by what holds a boundary's displacement [N], without its own pressure. In
  /// the plane per metre of thickness; in r-z around the whole circle.
  double reaction(const std::string& boundary, unsigned int component) const;

  /// Mean over the boundary [m].
  double mean_displacement(const std::string& boundary, unsigned int component) const;
  /// Between the boundary at rest and as it is displaced, outwards positive [m³].
  double swept_volume(const std::string& boundary) const;

  /// Of a boundary [m²].
  double area(const std::string& boundary) const;

  /// Mean over the volume.
  StressVector<material_dim> mean_stress() const;
  StrainVector<material_dim> mean_strain() const;

  const dealii::PETScWrappers::MPI::Vector& displacement() const { return accepted.displacement; } ///< with ghosts
  const dealii::DoFHandler<dim>& dofs() const { return dof_handler; }
  const dealii::Mapping<dim>& geometry() const { return mapping; }
  Kinematics kinematics() const { return parameters.kinematics; }
  const std::vector<std::string>& field_names() const { return material.field_names; }
  MPI_Comm communicator() const { return dof_handler.get_communicator(); }

  /// On all ranks.
  std::uint64_t n_points() const { return n_cells() * n_points_per_cell(); }

  // The points of this rank, in the order of its cells, n_points_per_cell() each.
  unsigned int n_points_per_cell() const { return quadrature.size(); }
  const MaterialPoints<material_dim>& material_points() const { return points; }
  /// Among all points; the same for any number of ranks.
  std::uint64_t number_of_point(const std::size_t i) const
  {
    return point_places[i].cell_number * n_points_per_cell() + point_places[i].quadrature_point;
  }
  const std::vector<PointPlace>& places() const { return point_places; }
  const std::vector<double>& volumes() const { return point_volumes; } ///< [m³]
  const std::vector<StrainVector<material_dim>>& strains() const { return accepted.strains; }
  const std::vector<MaterialAnswer<material_dim>>& answers() const { return accepted.answers; }

private:
  using Vector = dealii::PETScWrappers::MPI::Vector;

  struct State
  {
    Vector displacement;
    Vector internal_force; ///< on all nodes, as if nothing were held
    Vector external_force;
    std::vector<StrainVector<material_dim>> strains;
    std::vector<MaterialAnswer<material_dim>> answers;
    std::map<std::string, double> pressures;
  };

  void set_up();
  void set_up_dofs();
  void set_up_points();
  void set_up_constraints(const Load<dim>& load, double fraction);
  void set_up_matrix();
  void constrain_displacements(const Load<dim>& load, double fraction);
  void constrain_pins(const Load<dim>& load, double fraction);
  void constrain_free_plates(const Load<dim>& load);
  void assemble_forces(State& state);
  void assemble_system(const State& state, const dealii::AffineConstraints<double>& constraints);
  bool update_points(State& state);
  void note_round();
  void update_strains(State& state) const;
  NewtonReport iterate();
  std::optional<Vector> correction_by(const dealii::AffineConstraints<double>& asked);
  std::optional<Vector> following_correction();
  bool follows() const;
  double swept_between(const Vector& displacement) const;
  double correct(const Vector& correction);
  bool tangents_are_symmetric(const State& state) const;
  template <typename Value>
  double integral(const std::string& boundary, const Vector& displacement, const Value& value) const;
  std::uint64_t n_cells() const { return dof_handler.get_triangulation().n_global_active_cells(); }
  std::vector<StoredCell> brought_home(const std::vector<StoredCell>& cells) const;
  bool take(const std::vector<StoredCell>& cells);
  void move_cells(const std::vector<unsigned int>& weights);
  void place_on_curve();
  double seconds_of_cell(std::size_t cell) const;
  double pressure_of(const State& state, dealii::types::boundary_id boundary) const;
  Vector owned_vector() const { return Vector(owned, communicator()); }

  const SampleMesh<dim>& mesh;
  SolidParameters parameters;
  Material<material_dim> material;
  dealii::MappingQ<dim> mapping;
  dealii::FESystem<dim> fe;
  dealii::QGauss<dim> quadrature;
  dealii::QGauss<dim - 1> face_quadrature;
  dealii::DoFHandler<dim> dof_handler;
  dealii::IndexSet owned;
  dealii::IndexSet relevant;

  MaterialPoints<material_dim> points;
  std::vector<PointPlace> point_places;
  std::vector<double> point_volumes;
  // The curve through all cells that p4est cuts into pieces, one a rank.
  std::vector<std::size_t> cuts;           ///< as partition_cuts() tells them
  std::vector<std::size_t> cuts_at_first;  ///< before any cell moved
  std::vector<std::size_t> along_curve;    ///< the cells of this rank in its order
  std::vector<unsigned int> rank_at_first; ///< of each cell of this rank
  double cost_of_moving = 0.01;            ///< the last time, at first a guess [s]
  /// Since the last rebalance(), what all points of this rank took in each round, and thereof those of each rank's first
  /// cells [s].
  std::vector<double> rounds;
  std::vector<double> rounds_at_first;
  std::vector<double> seconds_noted; ///< of each cell of this rank, up to the last round

  State accepted;
  State tried;

  dealii::AffineConstraints<double> first_constraints;  ///< of the first correction, which moves the boundary
  dealii::AffineConstraints<double> constraints;        ///< of the others
  std::optional<typename Load<dim>::Follower> follower; ///< of the load that is tried
  double swept_before = 0.0;                            ///< by its boundaries, in the accepted state [m³]
  double swept_wanted = 0.0;                            ///< [m³]
  dealii::AffineConstraints<double> unit_constraints;   ///< its plate moves by one metre
  std::string constrained;                              ///< what the matrix was set up for
  dealii::PETScWrappers::MPI::SparseMatrix matrix;
  Vector right_side;
};
} // namespace feldspar::fem

#pragma once

#include "fem/solid/assembly.h"
#include "fem/solid/constraints.h"
#include "fem/solid/parameters.h"

#include <functional>
#include <optional>
#include <vector>

namespace feldspar::fem
{
/// One search of an equilibrium by Newton's method, cascade by cascade; docs/theory.md §8.3.
///
/// Between two cascades the structure of every point is frozen. Responses come from the points' accepted states, which
/// the search leaves as they are; it changes the points' structure at work.
template <int dim, int material_dim>
class NewtonSearch
{
public:
  /// matrix: with a pattern for these constraints. round_done is called each time that every point was asked.
  NewtonSearch(const Discretisation<dim>& elements, SolidPoints<material_dim>& points,
               const SolidParameters& parameters, dealii::PETScWrappers::MPI::SparseMatrix& matrix,
               std::function<void()> round_done);

  struct Outcome
  {
    NewtonReport report;
    SolidState<material_dim> state; ///< in equilibrium if it converged
  };

  /// Searches from an accepted state with the pressures that are wanted. Collective.
  Outcome run(SolidConstraints constraints, const SolidState<material_dim>& start);

private:
  /// The forces that a state carries, by which those that are unbalanced are measured [N].
  struct CarriedForce
  {
    double norm;       ///< of the internal or external forces, whichever is larger
    double along_axis; ///< from end to end, which is the last coordinate; at least the norm
  };
  CarriedForce carried_by(const SolidState<material_dim>& state) const;
  double unbalanced_resultant() const;
  PathVertex vertex_of(const SolidState<material_dim>& state) const;
  std::vector<bool> held_by(const dealii::AffineConstraints<double>& constraints) const;
  /// Outcome of a round over the points of all ranks: the worst of any, which is the last in this list.
  enum class Round
  {
    answered,
    failed, ///< a point had no response
    left    ///< before all were asked
  };
  template <typename Work>
  Round over_points(const Work& work);
  bool update_points();
  std::optional<std::uint64_t> relax_points();
  std::optional<NodalVector> next_correction(const SolidConstraints& constraints, bool boundary_moves);
  std::optional<NodalVector> correction_by(const dealii::AffineConstraints<double>& constraints);
  std::optional<NodalVector> following_correction(const SolidConstraints& constraints);
  double swept_by(const SolidConstraints::Following& following, const NodalVector& displacement) const;
  bool follows(const SolidConstraints& constraints) const;
  double correct(const NodalVector& correction);
  bool tangents_are_symmetric() const;

  const Discretisation<dim>& elements;
  SolidPoints<material_dim>& points;
  const SolidParameters& parameters;
  dealii::PETScWrappers::MPI::SparseMatrix& matrix;
  std::function<void()> round_done;

  dealii::IndexSet axial; ///< the degrees of freedom of this rank along the axis
  SolidState<material_dim> tried;
  NodalVector right_side; ///< unbalanced force on what is free to move
};
} // namespace feldspar::fem

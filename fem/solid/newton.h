#pragma once

#include "fem/solid/body.h"
#include "fem/solid/constraints.h"

#include <functional>

namespace feldspar::fem
{
template <int material_dim>
struct NewtonOutcome
{
  NewtonReport report;
  SolidState<material_dim> state; ///< in equilibrium if it converged
};

/// Searches an equilibrium by Newton's method, cascade by cascade, from an accepted state with the pressures that are wanted;
/// docs/theory.md §8.3.
///
/// Between two cascades the structure of every point is frozen. Responses come from the points' accepted states, which
/// the search leaves as they are; it changes the points' structure at work.
///
/// matrix: with a pattern for these constraints. round_done is called each time that every point was asked. Collective.
template <int dim, int material_dim>
NewtonOutcome<material_dim> find_equilibrium(SolidBody<dim, material_dim>& body, const SolidParameters& parameters,
                                             dealii::PETScWrappers::MPI::SparseMatrix& matrix,
                                             const std::function<void()>& round_done, SolidConstraints constraints,
                                             const SolidState<material_dim>& start);
} // namespace feldspar::fem

#pragma once

#include "fem/solid/discretisation.h"

#include <vector>

/// The work done on a solid at its boundary; docs/theory.md §8.3.
///
/// The path from one accepted state to the next has a vertex where equilibrium is found and one where points have just
/// changed their structure. Between two vertices forces and displacements are taken to go in proportion (trapezoidal rule).
namespace feldspar::fem
{
/// Works since the solid was at rest [J]; in the plane per metre of thickness.
struct BoundaryWork
{
  double reactions = 0.0; ///< of what holds displacements, times their travel
  double pressures = 0.0; ///< times the area they sweep
  /// Set free by nodes out of balance on their way to the next equilibrium after points changed their structure.
  double redistribution = 0.0;

  double total() const { return reactions + pressures; }

  BoundaryWork& operator+=(const BoundaryWork& other)
  {
    reactions += other.reactions;
    pressures += other.pressures;
    redistribution += other.redistribution;
    return *this;
  }
};

/// The entries of a vector for some of the degrees of freedom of this rank.
std::vector<double> entries(const NodalVector& vector, const dealii::IndexSet& wanted);

/// The degrees of freedom of this rank at a vertex of the path.
struct PathVertex
{
  std::vector<double> displacement;   ///< [m]
  std::vector<double> internal_force; ///< [N]
  std::vector<double> external_force; ///< [N]
};

/// Work by the forces on the degrees of freedom of this rank. `held` are those whose displacement is prescribed.
BoundaryWork work_between(const PathVertex& from, const PathVertex& to, const std::vector<bool>& held);

/// The work of all ranks. Collective.
BoundaryWork sum(const BoundaryWork& of_rank, MPI_Comm communicator);
} // namespace feldspar::fem

#include "fem/solid/boundary_work.h"

#include <deal.II/base/mpi.h>

#include <petscvec.h>

namespace feldspar::fem
{
std::vector<double> entries(const NodalVector& vector, const dealii::IndexSet& wanted)
{
  // extract_subvector_to() of deal.II 9.4 marks the vector as written, except where nothing is wanted. PETSc keeps the norm of a
  // vector that was not written: a process that owns no entry would skip the sum of the next norm, in which the others wait.
  const PetscScalar* owned = nullptr;
  VecGetArrayRead(vector, &owned);
  const auto begin = vector.local_range().first;
  std::vector<double> values;
  values.reserve(wanted.n_elements());
  for (const auto index : wanted)
    values.push_back(owned[index - begin]);
  VecRestoreArrayRead(vector, &owned);
  return values;
}

BoundaryWork work_between(const PathVertex& from, const PathVertex& to, const std::vector<bool>& held)
{
  BoundaryWork work;
  for (std::size_t i = 0; i < held.size(); ++i)
    {
      const double way = to.displacement[i] - from.displacement[i];
      const double external = 0.5 * (from.external_force[i] + to.external_force[i]);
      const double reaction = 0.5 * (from.internal_force[i] + to.internal_force[i]) - external;
      work.pressures += external * way;
      if (held[i])
        work.reactions += reaction * way;
      else
        work.redistribution -= reaction * way;
    }
  return work;
}

BoundaryWork sum(const BoundaryWork& of_rank, const MPI_Comm communicator)
{
  const auto over_ranks = [=](const double here) { return dealii::Utilities::MPI::sum(here, communicator); };
  return {over_ranks(of_rank.reactions), over_ranks(of_rank.pressures), over_ranks(of_rank.redistribution)};
}
} // namespace feldspar::fem

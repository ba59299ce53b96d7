#pragma once

#include <functional>
#include <memory>

namespace feldspar
{
/// Returns whether mpirun or srun started this process, perhaps with others. Other processes initialise MPI only where they need
/// it, for that takes half a second.
bool is_launched();

/// Keeps MPI up while it lives, with what else needs to be up: of any type.
using MpiSession = std::shared_ptr<void>;

/// The processes of one machine share its cores, as with deal.II.
MpiSession mpi_alone();

/// MPI, and all that deal.II needs with it; in finite_elements.cc, of the program that has deal.II.
MpiSession mpi_and_finite_elements();

/// Runs a program with MPI up, on all processes that were started together. Returns the exit code; throws what the program
/// throws, once MPI is down.
int with_mpi(const std::function<int()>& program, MpiSession (*bring_up)() = mpi_alone);
} // namespace feldspar

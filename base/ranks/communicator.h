#pragma once

#include <mpi.h>

namespace feldspar::ranks
{
/// Makes the processes of a communicator those of ranks.h, for as long as it lives. MPI is up as long. There is one at a
/// time: the program hands its processes down once.
class Group
{
public:
  /// `of_machine`: those of them on this machine, where it is known.
  explicit Group(MPI_Comm communicator, MPI_Comm of_machine = MPI_COMM_NULL);
  Group(const Group&) = delete;
  Group& operator=(const Group&) = delete;
  ~Group();
};

/// The communicator of these processes; MPI_COMM_NULL without a Group.
MPI_Comm communicator();
} // namespace feldspar::ranks

#include "app/processes/mpi_session.h"

#include <deal.II/base/mpi.h>

#include <csignal>
#include <memory>

namespace feldspar
{
MpiSession mpi_and_finite_elements()
{
  int n_arguments = 0;
  char** no_arguments = nullptr;
  // The limit of one thread that deal.II's tutorials set is left out, so that the processes of a machine share its
  // cores.
  auto session = std::make_shared<dealii::Utilities::MPI::MPI_InitFinalize>(n_arguments, no_arguments);
  std::signal(SIGPIPE, SIG_IGN); // as in main(): deal.II takes back PETSc's signal handlers, and that one with them
  return session;
}
} // namespace feldspar

#include "app/run/finite_elements.h"

#include <deal.II/base/mpi.h>

#include <memory>

namespace feldspar
{
MpiSession mpi_and_finite_elements()
{
  static int n_arguments = 0;
  static char** no_arguments = nullptr;
  // No limit of threads here, as deal.II's tutorials have it: it would leave the RVEs one worker.
  return std::make_shared<dealii::Utilities::MPI::MPI_InitFinalize>(n_arguments, no_arguments);
}
} // namespace feldspar

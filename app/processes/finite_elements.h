#pragma once

#include "app/processes/mpi_session.h"

namespace feldspar
{
/// MPI, and all that deal.II needs with it.
MpiSession mpi_and_finite_elements();
} // namespace feldspar

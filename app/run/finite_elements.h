#pragma once

#include "app/run/launched.h"

namespace feldspar
{
/// MPI, and all that deal.II needs with it.
MpiSession mpi_and_finite_elements();
} // namespace feldspar

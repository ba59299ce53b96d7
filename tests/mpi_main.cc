// main of the tests that need MPI. As a program of ours it does not set the limit of one thread of the tutorials, which
// would leave oneTBB a single worker.

#include "base/ranks/communicator.h"

#include <deal.II/base/mpi.h>

#include <gtest/gtest.h>

#include <cstdlib>

int main(int argc, char** argv)
{
  testing::InitGoogleTest(&argc, argv);
  setenv("OMPI_MCA_sharedfp", "individual", 0); // as run_multiscale() has it
  const dealii::Utilities::MPI::MPI_InitFinalize mpi(argc, argv);
  const feldspar::ranks::Group all(MPI_COMM_WORLD);
  // One voice is enough, unless another rank fails.
  if (dealii::Utilities::MPI::this_mpi_process(MPI_COMM_WORLD) != 0)
    delete testing::UnitTest::GetInstance()->listeners().Release(
      testing::UnitTest::GetInstance()->listeners().default_result_printer());
  return RUN_ALL_TESTS();
}

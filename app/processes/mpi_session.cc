#include "app/processes/mpi_session.h"

#include "base/quoted.h"
#include "base/ranks/communicator.h"
#include "base/ranks/ranks.h"

#include <fmt/format.h>
#include <tbb/global_control.h>
#include <tbb/info.h>

#include <algorithm>
#include <array>
#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <exception>
#include <thread>

namespace feldspar
{
bool is_launched()
{
  // Variables of Open MPI's mpirun, of PMI (srun, MPICH) and of PMIx (srun).
  constexpr std::array variables{"OMPI_COMM_WORLD_SIZE", "PMI_RANK", "PMIX_RANK"};
  return std::ranges::any_of(variables, [](const char* name) { return std::getenv(name) != nullptr; });
}

namespace
{
/// The processes that are handed down to all libraries; no other place names them.
MPI_Comm all_started() { return MPI_COMM_WORLD; }

/// The started processes that run on this machine.
struct OfThisMachine
{
  OfThisMachine() { MPI_Comm_split_type(all_started(), MPI_COMM_TYPE_SHARED, 0, MPI_INFO_NULL, &communicator); }
  OfThisMachine(const OfThisMachine&) = delete;
  OfThisMachine& operator=(const OfThisMachine&) = delete;
  ~OfThisMachine() { MPI_Comm_free(&communicator); }

  MPI_Comm communicator = MPI_COMM_NULL;
};

/// Returns whether every rank calls this within some seconds. The communicator is of no other use: others may be waiting in
/// another collective call.
bool all_are_here(const MPI_Comm communicator)
{
  using namespace std::chrono_literals;
  MPI_Request request;
  MPI_Ibarrier(communicator, &request);
  const auto end = std::chrono::steady_clock::now() + 10s;
  int done = 0;
  while (done == 0 && std::chrono::steady_clock::now() < end)
    {
      MPI_Test(&request, &done, MPI_STATUS_IGNORE);
      std::this_thread::sleep_for(10ms);
    }
  return done != 0;
}

/// Runs a program of all ranks, and leaves none waiting for another. What it throws on all of them the first rethrows;
/// where a rank is alone with it, it says so and ends all. The exit code is that of the first, 0 on others: mpirun ends all
/// once one has another.
int guarded(const std::function<int()>& program)
{
  if (ranks::number() == 1)
    return program();
  MPI_Comm of_failures;
  MPI_Comm_dup(ranks::communicator(), &of_failures);
  try
    {
      const int exit_code = program();
      MPI_Comm_free(&of_failures);
      return ranks::is_first() ? exit_code : 0;
    }
  catch (const std::exception& error)
    {
      if (!all_are_here(of_failures))
        {
          std::fputs(fmt::format("feldspar: process {} of {} failed and ends all: {}\n", ranks::mine(), ranks::number(),
                                 printable(error.what()))
                       .c_str(),
                     stderr);
          std::fflush(stderr);
          constexpr int failed = 1;
          MPI_Abort(ranks::communicator(), failed);
        }
      MPI_Comm_free(&of_failures);
      if (!ranks::is_first())
        return 0;
      throw;
    }
}
} // namespace

MpiSession mpi_alone()
{
  int provided = 0;
  MPI_Init_thread(nullptr, nullptr, MPI_THREAD_SERIALIZED, &provided);
  int n = 1;
  MPI_Comm_size(OfThisMachine().communicator, &n);
  auto share_of_cores = std::make_unique<tbb::global_control>(
    tbb::global_control::max_allowed_parallelism, std::size_t(std::max(1, tbb::info::default_concurrency() / n)));
  return {share_of_cores.release(), [](tbb::global_control* const share) {
            MPI_Finalize();
            delete share;
          }};
}

int with_mpi(const std::function<int()>& program, MpiSession (*const bring_up)())
{
  setenv("OMPI_MCA_btl_base_warn_component_unused", "0", 0);
  setenv("HWLOC_COMPONENTS", "-gl", 0); // which would connect to a display, and end with it
  // File pointers that processes share, which HDF5 has no use for. By default Open MPI keeps them in its folder for temporary
  // files and waits without end where that is full; and it guards each by a semaphore of the file's name, which a run that
  // is killed meanwhile leaves taken, so that every later run with such a file would wait for ever.
  setenv("OMPI_MCA_sharedfp", "individual", 0);
  int exit_code = 0;
  std::exception_ptr failure; // kept until MPI is down: it does not go down while an exception is under way
  {
    const MpiSession mpi = bring_up();
    const OfThisMachine of_this_machine;
    const ranks::Group all(all_started(), of_this_machine.communicator);
    try
      {
        exit_code = guarded(program);
      }
    catch (...)
      {
        failure = std::current_exception();
      }
  }
  if (failure)
    std::rethrow_exception(failure);
  return exit_code;
}
} // namespace feldspar

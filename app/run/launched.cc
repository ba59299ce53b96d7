#include "app/run/launched.h"

#include "coupling/sample/ranks.h"
#include "runs/share_out.h"

#include <mpi.h>
#include <tbb/global_control.h>
#include <tbb/info.h>

#include <algorithm>
#include <array>
#include <cstdlib>
#include <exception>
#include <memory>
#include <optional>

namespace feldspar
{
namespace
{
RunEnd go(const Run& run, const SharedRun& shared)
{
  Progress progress(run.quiet || !ranks::is_first());
  if (ranks::number() == 1)
    return shared.go_alone(run, progress);
  shared.share_out(run, progress);
  RunEnd end{};
  together_or_interrupted([&] {
    if (ranks::is_first())
      end = shared.go_alone(run, progress);
  });
  end.was_interrupted = ranks::any(end.was_interrupted);
  return end;
}
} // namespace

bool is_launched()
{
  // Of Open MPI's mpirun, of PMI (srun, MPICH) and of PMIx (srun).
  constexpr std::array variables{"OMPI_COMM_WORLD_SIZE", "PMI_RANK", "PMIX_RANK"};
  return std::any_of(variables.begin(), variables.end(), [](const char* name) { return std::getenv(name) != nullptr; });
}

namespace
{
class MpiAlone
{
public:
  MpiAlone()
  {
    int provided = 0;
    MPI_Init_thread(nullptr, nullptr, MPI_THREAD_SERIALIZED, &provided);
    MPI_Comm of_machine;
    MPI_Comm_split_type(MPI_COMM_WORLD, MPI_COMM_TYPE_SHARED, 0, MPI_INFO_NULL, &of_machine);
    int n = 1;
    MPI_Comm_size(of_machine, &n);
    MPI_Comm_free(&of_machine);
    share_of_cores.emplace(tbb::global_control::max_allowed_parallelism,
                           std::size_t(std::max(1, tbb::info::default_concurrency() / n)));
  }
  MpiAlone(const MpiAlone&) = delete;
  MpiAlone& operator=(const MpiAlone&) = delete;
  ~MpiAlone() { MPI_Finalize(); }

private:
  std::optional<tbb::global_control> share_of_cores;
};
} // namespace

MpiSession mpi_alone() { return std::make_shared<MpiAlone>(); }

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
    try
      {
        exit_code = ranks::guarded(program);
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

Processes all_processes() { return {ranks::is_first(), ranks::first, ranks::of_first}; }

int run_shared(const std::string& name,
               const std::function<void(const Input&, const std::filesystem::path& input_file)>& check,
               const SharedRun& plane, const SharedRun& space, const CommonOptions& options)
{
  const auto program = [&] {
    const auto by_dimension = [&](const Run& run) {
      return go(run, run.input.specimen.dimension == 2 ? plane : space);
    };
    return run_command({name, check, by_dimension, all_processes()}, options);
  };
  return is_launched() ? with_mpi(program) : program();
}
} // namespace feldspar

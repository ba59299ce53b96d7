#pragma once

#include "app/run/run.h"
#include "app/screen/progress.h"

#include <functional>
#include <memory>
#include <string>

namespace feldspar
{
/// Whether mpirun or srun started this process, perhaps with others. A process that nobody started so does without MPI
/// where it can: it is up at once.
bool is_launched();

/// Keeps MPI up while it lives, with what else needs to be up: of any type.
using MpiSession = std::shared_ptr<void>;

/// The processes of one machine share its cores, as with deal.II.
MpiSession mpi_alone();

/// Runs a program with MPI up, on all processes that were started together. Returns the exit code; throws what the program
/// throws, once MPI is down.
int with_mpi(const std::function<int()>& program, MpiSession (*bring_up)() = mpi_alone);

/// All of them, for a run that they make together. MPI is up, or there is one process.
Processes all_processes();

/// A run whose parts several processes can make, each its own.
struct SharedRun
{
  std::function<void(const Run&, Progress&)> share_out; ///< each process its parts, which it leaves in the folder
  std::function<RunEnd(const Run&, Progress&)>
    go_alone; ///< all parts that the folder does not have yet, and the report
};

/// Runs a command in the plane or in space, by all processes that were started together: the first takes up what all have
/// done, as after an interruption. Returns the exit code.
int run_shared(const std::string& name,
               const std::function<void(const Input&, const std::filesystem::path& input_file)>& check,
               const SharedRun& plane, const SharedRun& space, const CommonOptions& options);
} // namespace feldspar

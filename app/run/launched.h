#pragma once

#include "app/run/run.h"
#include "app/screen/progress.h"

#include <functional>
#include <string>

namespace feldspar
{
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

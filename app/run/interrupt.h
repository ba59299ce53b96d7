#pragma once

#include <exception>

namespace feldspar
{
/// The end of work that was asked to end and has nothing to hand over.
struct Interrupted : std::exception
{
  const char* what() const noexcept override { return "interrupted"; }
};

/// From now on the first Ctrl-C, SIGTERM, SIGHUP (of a terminal that closes, unless nohup has it ignored) or SIGUSR1
/// (which mpirun passes on without ending the run itself) only asks the run to end; the second ends it at once.
/// `acknowledged`: at once by a line on standard error.
void watch_for_interrupt(bool acknowledged);

/// Whether the run was asked to end.
bool interrupted();

/// Throws Interrupted where the run was asked to end.
void end_if_interrupted();
} // namespace feldspar

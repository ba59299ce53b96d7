#pragma once

#include "runs/observer.h"

#include <chrono>

namespace feldspar
{
/// Watches for interrupts: from now on the first Ctrl-C, SIGTERM, SIGHUP (of a terminal that closes, unless nohup has
/// it ignored) or SIGUSR1 (which mpirun passes on without ending the run itself) only asks the run to end; the second
/// ends it at once. `acknowledged`: at once by a line on standard error.
void watch_for_interrupt(bool acknowledged);

/// Returns whether the run was asked to end.
bool interrupted();

/// For work that may take long after an interrupt, such as drawing: whether the run was asked to end and, if that was
/// before this object was made, some seconds have passed since.
class EndOfPatience
{
public:
  bool operator()() const
  {
    return interrupted() && (!was_interrupted_before || std::chrono::steady_clock::now() > deadline);
  }

private:
  bool was_interrupted_before = interrupted();
  std::chrono::steady_clock::time_point deadline = std::chrono::steady_clock::now() + std::chrono::seconds(5);
};

/// Throws Interrupted where the run was asked to end.
void end_if_interrupted();
} // namespace feldspar

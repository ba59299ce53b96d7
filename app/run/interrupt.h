#pragma once

#include "runs/observer.h"

#include <functional>

namespace feldspar
{
/// Watches for interrupts: from now on the first Ctrl-C, SIGTERM, SIGHUP (of a terminal that closes, unless nohup has
/// it ignored) or SIGUSR1 (which mpirun passes on without ending the run itself) only asks the run to end; the second
/// ends it at once. `acknowledged`: at once by a line on standard error.
void watch_for_interrupt(bool acknowledged);

/// Returns whether the run was asked to end.
bool interrupted();

/// For work that may take long after an interrupt, such as drawing: whether the run was asked to end and, if that was
/// before this call, some seconds have passed since.
std::function<bool()> end_of_patience();

/// Throws Interrupted where the run was asked to end.
void end_if_interrupted();
} // namespace feldspar

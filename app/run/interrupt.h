#pragma once

namespace feldspar
{
/// From now on the first Ctrl-C, SIGTERM or SIGUSR1 (which mpirun passes on without ending the run itself) only asks the
/// run to end; the second ends it at once.
void watch_for_interrupt();

/// Whether the run was asked to end.
bool interrupted();
} // namespace feldspar

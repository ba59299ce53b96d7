#pragma once

namespace feldspar
{
/// From now on the first Ctrl-C (or SIGTERM) only asks the run to end; the second ends it at once.
void watch_for_interrupt();

/// Whether the run was asked to end.
bool interrupted();
} // namespace feldspar

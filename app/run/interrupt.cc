#include "app/run/interrupt.h"

#include <csignal>

#include <atomic>

namespace feldspar
{
namespace
{
// A signal handler is given nothing, so that what it says has to be global.
std::atomic<bool> was_interrupted = false;
static_assert(std::atomic<bool>::is_always_lock_free);

void note_interrupt(int) { was_interrupted = true; }
} // namespace

void watch_for_interrupt()
{
  struct sigaction action = {};
  action.sa_handler = note_interrupt;
  action.sa_flags = SA_RESTART | static_cast<int>(SA_RESETHAND);
  sigaction(SIGINT, &action, nullptr);
  sigaction(SIGTERM, &action, nullptr);
  sigaction(SIGUSR1, &action, nullptr);
  struct sigaction at_hangup = {};
  sigaction(SIGHUP, nullptr, &at_hangup);
  if (at_hangup.sa_handler != SIG_IGN)
    sigaction(SIGHUP, &action, nullptr);
}

bool interrupted() { return was_interrupted; }

void end_if_interrupted()
{
  if (was_interrupted)
    throw Interrupted();
}
} // namespace feldspar

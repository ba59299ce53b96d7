#include "app/run/interrupt.h"

#include <csignal>

#include <unistd.h>

#include <atomic>
#include <chrono>
#include <string_view>

namespace feldspar
{
namespace
{
// A signal handler is given nothing, so that what it says has to be global.
std::atomic<bool> was_interrupted = false;
static_assert(std::atomic<bool>::is_always_lock_free);

std::atomic<bool> is_acknowledged = false;

void note_interrupt(int)
{
  was_interrupted = true;
  constexpr std::string_view message =
    "\nfeldspar: asked to end; what runs is kept first (a second signal ends at once)\n";
  if (is_acknowledged && write(STDERR_FILENO, message.data(), message.size()) < 0)
    is_acknowledged = false; // nobody listens
}
} // namespace

void watch_for_interrupt(const bool acknowledged)
{
  is_acknowledged = acknowledged;
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

std::function<bool()> end_of_patience()
{
  using Clock = std::chrono::steady_clock;
  return [was_interrupted_before = interrupted(), deadline = Clock::now() + std::chrono::seconds(5)] {
    return interrupted() && (!was_interrupted_before || Clock::now() > deadline);
  };
}

void end_if_interrupted()
{
  if (was_interrupted)
    throw Interrupted();
}
} // namespace feldspar

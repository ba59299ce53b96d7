#include "base/system/child_process.h"

#include "base/input_error.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <poll.h>
#include <sys/prctl.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <csignal>
#include <cstring>
#include <exception>
#include <fstream>
#include <optional>
#include <stdexcept>
#include <system_error>
#include <vector>

namespace feldspar
{
namespace
{
// A child process says in its first character what follows.
constexpr char is_text = '=';
constexpr char is_problem = '!';

void limit_process(const ProcessLimits& limits)
{
  const auto limit = [](const auto resource, const std::uint64_t most) {
    const rlimit wanted{rlim_t(most), rlim_t(most)};
    setrlimit(resource, &wanted);
  };
  limit(RLIMIT_CORE, 0);
  limit(RLIMIT_CPU, limits.seconds);
  std::uint64_t pages = 0;
  if (std::ifstream("/proc/self/statm") >> pages)
    limit(RLIMIT_AS, pages * std::uint64_t(sysconf(_SC_PAGESIZE)) + limits.bytes_beyond);
}

/// The child: puts its text, or what went wrong, into a pipe.
[[noreturn]] void work_as_child(const int pipe, const ProcessLimits& limits, const std::function<std::string()>& work)
{
  prctl(PR_SET_PDEATHSIG, SIGKILL);
  for (const int signal :
       {SIGINT, SIGTERM, SIGHUP, SIGUSR1, SIGXCPU, SIGFPE, SIGSEGV, SIGBUS, SIGILL, SIGABRT, SIGPIPE})
    std::signal(signal, SIG_DFL);
  if (const int nowhere = open("/dev/null", O_WRONLY); nowhere >= 0)
    dup2(nowhere, STDERR_FILENO); // the last words of libraries
  std::string reply;
  try
    {
      limit_process(limits);
      reply = is_text + work();
    }
  catch (const std::exception& error)
    {
      reply = is_problem + std::string(error.what());
    }
  for (std::size_t at = 0; at < reply.size();)
    if (const ssize_t n = write(pipe, reply.data() + at, reply.size() - at); n > 0)
      at += std::size_t(n);
    else
      break;
  _exit(0);
}

/// A child process and the end of its pipe, which end with this object.
struct Child
{
  Child(const pid_t of_process, const int end_of_pipe)
    : pid(of_process)
    , out(end_of_pipe)
  {
  }
  Child(const Child&) = delete;
  Child& operator=(const Child&) = delete;
  ~Child()
  {
    if (pid > 0)
      {
        kill(pid, SIGKILL);
        wait();
      }
    close(out);
  }

  /// Waits for the child and returns its status by <sys/wait.h>; none where another has taken it.
  std::optional<int> wait()
  {
    int status = 0;
    pid_t ended = 0;
    do
      ended = waitpid(pid, &status, 0);
    while (ended < 0 && errno == EINTR);
    pid = 0;
    return ended > 0 ? std::optional(status) : std::nullopt;
  }

  pid_t pid;
  int out;
};
} // namespace

std::string made_by_child(const std::string& worker, const ProcessLimits& limits,
                          const std::function<std::string()>& work, const std::function<void()>& check)
{
  const auto fail = [](const char* what, const int error) {
    throw std::runtime_error(fmt::format("{}: {}", what, std::generic_category().message(error)));
  };
  std::array<int, 2> ends{};
  if (pipe2(ends.data(), O_CLOEXEC) != 0)
    fail("no pipe to a child process", errno);
  Child child(fork(), ends[0]);
  if (child.pid == 0)
    work_as_child(ends[1], limits, work);
  const int error = errno;
  close(ends[1]);
  if (child.pid < 0)
    fail("no child process", error);

  std::string reply;
  std::vector<char> piece(std::size_t(1) << 16);
  for (;;)
    {
      constexpr int a_moment = 100; // ms
      check();
      pollfd wanted{child.out, POLLIN, 0};
      if (poll(&wanted, 1, a_moment) <= 0)
        continue;
      const ssize_t n = ::read(child.out, piece.data(), piece.size());
      if (n < 0 && errno == EINTR)
        continue;
      if (n <= 0)
        break;
      reply.append(piece.data(), std::size_t(n));
    }
  const std::optional<int> status = child.wait();
  check();
  if (status && WIFSIGNALED(*status))
    {
      const int signal = WTERMSIG(*status);
      throw InputError(signal == SIGXCPU || signal == SIGKILL
                         ? fmt::format("damaged: {} does not end on it within its limit of time", worker)
                         : fmt::format("damaged: {} fails on it (SIG{})", worker, sigabbrev_np(signal)));
    }
  if (reply.empty() || reply[0] != is_text)
    throw InputError(reply.empty() ? "cannot be read" : reply.substr(1));
  reply.erase(0, 1);
  return reply;
}
} // namespace feldspar

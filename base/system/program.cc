#include "base/system/program.h"

#include <csignal>
#include <cstdlib>
#include <sstream>
#include <thread>

#include <fcntl.h>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

namespace feldspar
{
ProgramEnd run_program(std::vector<std::string> command, const std::filesystem::path& folder,
                       const std::chrono::milliseconds longest, const std::function<bool()>& is_over,
                       const std::filesystem::path& output)
{
  posix_spawn_file_actions_t actions;
  posix_spawn_file_actions_init(&actions);
  for (const int stream : {STDIN_FILENO, STDERR_FILENO})
    posix_spawn_file_actions_addopen(&actions, stream, "/dev/null", O_RDWR, 0);
  posix_spawn_file_actions_addopen(&actions, STDOUT_FILENO, output.c_str(), O_WRONLY | O_CREAT | O_TRUNC, 0600);
  posix_spawn_file_actions_addchdir_np(&actions, folder.c_str());
  posix_spawnattr_t attributes;
  posix_spawnattr_init(&attributes);
  posix_spawnattr_setflags(&attributes, POSIX_SPAWN_SETPGROUP);
  posix_spawnattr_setpgroup(&attributes, 0);
  std::vector<char*> arguments;
  for (std::string& word : command)
    arguments.push_back(word.data());
  arguments.push_back(nullptr);
  pid_t child = 0;
  const bool started = posix_spawnp(&child, arguments.front(), &actions, &attributes, arguments.data(), environ) == 0;
  posix_spawnattr_destroy(&attributes);
  posix_spawn_file_actions_destroy(&actions);
  if (!started)
    return ProgramEnd::failed;

  const auto deadline = std::chrono::steady_clock::now() + longest;
  constexpr std::chrono::milliseconds between_looks(5);
  int status = -1;
  pid_t ended = 0;
  while ((ended = waitpid(child, &status, WNOHANG)) == 0)
    {
      const bool is_late = std::chrono::steady_clock::now() > deadline;
      if (is_late || is_over())
        {
          kill(-child, SIGKILL);
          waitpid(child, &status, 0);
          return is_late ? ProgramEnd::hung : ProgramEnd::called_off;
        }
      std::this_thread::sleep_for(between_looks);
    }
  return ended == child && WIFEXITED(status) && WEXITSTATUS(status) == 0 ? ProgramEnd::done : ProgramEnd::failed;
}

bool is_installed(const std::string& program)
{
  const char* const path = std::getenv("PATH");
  std::istringstream folders(path == nullptr ? "" : path);
  for (std::string folder; std::getline(folders, folder, ':');)
    if (access((std::filesystem::path(folder) / program).c_str(), X_OK) == 0)
      return true;
  return false;
}
} // namespace feldspar

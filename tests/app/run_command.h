#pragma once

#include "tests/temporary_folder.h"

#include <array>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <stdexcept>
#include <string>

#include <sys/wait.h>

namespace feldspar::tests
{
struct Outcome
{
  int exit_code;
  std::string output; ///< standard output
  std::string error;  ///< standard error
};

/// Runs a command by the shell in `folder`.
inline Outcome run_command(const std::filesystem::path& folder, const std::string& words)
{
  // Beside the folder, not in it: tests inspect what a run leaves there.
  const std::string error_file = folder.string() + ".stderr";
  const std::string command = "cd '" + folder.string() + "' && " + words + " 2>'" + error_file + "'";
  FILE* pipe = popen(command.c_str(), "r");
  if (!pipe)
    throw std::runtime_error("no shell");
  Outcome outcome{};
  std::array<char, 4096> buffer;
  while (const std::size_t n = fread(buffer.data(), 1, buffer.size(), pipe))
    outcome.output.append(buffer.data(), n);
  const int status = pclose(pipe);
  outcome.exit_code = WIFEXITED(status) ? WEXITSTATUS(status) : -1;
  std::ifstream error(error_file);
  outcome.error.assign(std::istreambuf_iterator<char>(error), {});
  std::filesystem::remove(error_file);
  return outcome;
}

/// Runs `feldspar ARGUMENTS` in `folder`. `environment`: assignments before the command.
inline Outcome run_feldspar(const std::filesystem::path& folder, const std::string& arguments,
                            const std::string& environment = "")
{
  return run_command(folder, environment + " '" FELDSPAR_COMMAND "' " + arguments);
}

/// Search path of programs, for the shell, in which gnuplot fails at once.
inline std::string path_without_gnuplot()
{
  static const TemporaryFolder programs;
  static const bool is_linked = [] {
    std::filesystem::create_symlink("/bin/false", programs.path() / "gnuplot");
    return true;
  }();
  return is_linked ? "PATH=\"" + programs.path().string() + ":$PATH\"" : "";
}

/// The same of a run on whose pictures there is no claim: gnuplot takes most of the time of a small run. For runs with
/// --quiet, which do not name what is missing.
inline Outcome run_without_pictures(const std::filesystem::path& folder, const std::string& arguments)
{
  return run_feldspar(folder, arguments, path_without_gnuplot());
}

/// Runs it until a condition of the shell holds in `folder`, then kills it; it may have come to its end before.
inline void run_and_kill_once(const std::filesystem::path& folder, const std::string& arguments,
                              const std::string& condition)
{
  const std::string script = folder.string() + ".kill";
  std::ofstream(script) << "\"$@\" &\n"
                           "while kill -0 $! 2>/dev/null; do\n"
                           "  if "
                        << condition << "; then kill -KILL $!; fi\n  sleep 0.01\ndone\n";
  run_feldspar(folder, arguments, "sh '" + script + "'");
  std::filesystem::remove(script);
}

/// Assignments and launcher before the command. Ranks that wait give way, as there may be fewer cores. They find no gnuplot:
/// no claim is on the pictures.
inline std::string mpirun(const unsigned int n_ranks)
{
  return "env OMPI_ALLOW_RUN_AS_ROOT=1 OMPI_ALLOW_RUN_AS_ROOT_CONFIRM=1 HWLOC_COMPONENTS=-gl "
         "OMPI_MCA_mpi_yield_when_idle=1 mpirun -x " +
         path_without_gnuplot() + " -np " + std::to_string(n_ranks) + " --oversubscribe";
}
} // namespace feldspar::tests

#pragma once

#include "tests/content.h"
#include "tests/temporary_folder.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <map>
#include <set>
#include <sstream>
#include <stdexcept>
#include <string>
#include <vector>

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

/// Search path of programs, for the shell, in which the programs that draw fail at once.
inline std::string path_without_pictures()
{
  static const TemporaryFolder programs;
  static const bool is_linked = [] {
    for (const char* const program : {"gnuplot", "chromium", "google-chrome"})
      std::filesystem::create_symlink("/bin/false", programs / program);
    return true;
  }();
  return is_linked ? "PATH=\"" + programs.path().string() + ":$PATH\"" : "";
}

/// The same of a run on whose pictures there is no claim: they take most of the time of a small run. For runs with --quiet,
/// which do not name what is missing.
inline Outcome run_without_pictures(const std::filesystem::path& folder, const std::string& arguments)
{
  return run_feldspar(folder, arguments, path_without_pictures());
}

constexpr const char* with_pictures = "";

/// Runs it to its end, without pictures, or throws with what it said.
inline Outcome run_to_end(const std::filesystem::path& folder, const std::string& arguments,
                          const std::string& environment = path_without_pictures())
{
  const Outcome outcome = run_feldspar(folder, arguments, environment);
  if (outcome.exit_code != 0)
    throw std::runtime_error("code " + std::to_string(outcome.exit_code) + " of " + arguments + ": " + outcome.error);
  return outcome;
}

/// Returns whether all these words stand in a text, and if not which are missing: for EXPECT_TRUE().
template <typename... Words>
testing::AssertionResult has_words(const std::string& text, const Words&... words)
{
  std::string missing;
  ((missing += text.find(words) == std::string::npos ? "\nmissing: " + std::string(words) : ""), ...);
  return missing.empty() ? testing::AssertionSuccess() : testing::AssertionFailure() << text.substr(0, 8000) << missing;
}

inline std::vector<std::string> words_of(const std::string& text)
{
  std::istringstream in(text);
  return {std::istream_iterator<std::string>(in), {}};
}

inline std::size_t n_lines(const std::string& text) { return std::size_t(std::count(text.begin(), text.end(), '\n')); }

/// Everything below a folder by its name.
inline std::set<std::string> names_in(const std::filesystem::path& folder)
{
  std::set<std::string> names;
  for (const auto& entry : std::filesystem::recursive_directory_iterator(folder))
    names.insert(entry.path().string());
  return names;
}

/// Every file below a folder with its bytes; lists of files are left out.
inline std::map<std::string, std::string> all_files(const std::filesystem::path& folder)
{
  std::map<std::string, std::string> files;
  for (const auto& entry : std::filesystem::recursive_directory_iterator(folder))
    if (entry.is_regular_file() && entry.path().filename() != ".feldspar-files")
      files[entry.path().lexically_relative(folder).string()] = content(entry.path());
  return files;
}

/// A run that goes wrong: code 2, and one line on standard error that holds these words, or begins with them where they are
/// `feldspar: ...`.
inline Outcome expect_mistake(const std::filesystem::path& folder, const std::string& arguments,
                              const std::string& words, const std::string& environment = path_without_pictures())
{
  const Outcome outcome = run_feldspar(folder, arguments, environment);
  EXPECT_EQ(outcome.exit_code, 2) << arguments;
  const std::size_t found = outcome.error.find(words);
  EXPECT_TRUE(found == 0 || (found != std::string::npos && !words.starts_with("feldspar: ")))
    << arguments << "\nfound: " << outcome.error << "wanted: " << words;
  EXPECT_EQ(n_lines(outcome.error), 1u) << outcome.error;
  return outcome;
}

/// A mistake of the user: the same at once and before any work, so that nothing is made, changed or taken out.
inline void expect_refused(const std::filesystem::path& folder, const std::string& arguments, const std::string& words,
                           const std::string& environment = "timeout 60")
{
  const std::set<std::string> before = names_in(folder);
  const auto files_before = all_files(folder);
  EXPECT_EQ(expect_mistake(folder, arguments, words, environment).output, "") << arguments;
  EXPECT_EQ(names_in(folder), before) << arguments;
  EXPECT_TRUE(all_files(folder) == files_before) << arguments << ": files were changed";
}

/// Runs it until a condition of the shell holds in `folder`, then does this to the process $!; it may have come to its end
/// before. `launcher`: words before the command.
inline Outcome run_until(const std::filesystem::path& folder, const std::string& arguments,
                         const std::string& condition, const std::string& action, const std::string& launcher = "")
{
  const std::string script = folder.string() + ".script";
  std::ofstream(script) << "\"$@\" &\nwhile kill -0 $! 2>/dev/null && ! { " << condition << "; }; do sleep 0.01; done\n"
                        << action << "\nwait $!\n";
  const Outcome outcome = run_feldspar(folder, arguments, "timeout 600 sh '" + script + "' " + launcher);
  std::filesystem::remove(script);
  return outcome;
}

/// Assignments and launcher before the command. Ranks that wait give way, as there may be fewer cores. They draw no pictures:
/// no claim is on them.
inline std::string mpirun(const unsigned int n_ranks)
{
  return "env OMPI_ALLOW_RUN_AS_ROOT=1 OMPI_ALLOW_RUN_AS_ROOT_CONFIRM=1 HWLOC_COMPONENTS=-gl "
         "OMPI_MCA_mpi_yield_when_idle=1 mpirun -x " +
         path_without_pictures() + " -np " + std::to_string(n_ranks) + " --oversubscribe";
}
} // namespace feldspar::tests

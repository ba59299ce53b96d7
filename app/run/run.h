#pragma once

#include "app/input/input.h"
#include "app/run/file_list.h"
#include "app/screen/progress.h"

#include <filesystem>
#include <functional>
#include <optional>
#include <string>
#include <vector>

/// A run in its folder: begun or resumed, ended by its end, by Ctrl-C or by an error; the same for every command that
/// runs long.
namespace feldspar
{
namespace exit_code
{
inline constexpr int internal_error = 1;
inline constexpr int user_error = 2;
inline constexpr int output_error = 3;  // a full disk
inline constexpr int missed = 4;        // a calibration that did not reach its targets
inline constexpr int not_decided = 5;   // one whose packings do not tell whether it did
inline constexpr int interrupted = 130; // 128 + SIGINT, as shells have it
} // namespace exit_code

/// The options of the command line that `lab`, `rve`, `multiscale`, `specimen` and `contact` have in common.
struct CommonOptions
{
  std::filesystem::path input;
  std::vector<std::string> settings;           ///< Section/Entry = value each, in place of what the input says
  std::optional<std::filesystem::path> resume; ///< of those that run long: the folder to be resumed
  std::optional<std::string> extract;          ///< of `multiscale`: CELL:POINT; the input is the folder of a run
  std::vector<std::string> packings;           ///< of `specimen`: forms in which grains are written for other programs
  std::optional<std::filesystem::path> output;
  bool force = false;
  bool quiet = false;
};

/// A run as its command finds it.
struct Run
{
  std::filesystem::path folder;
  std::filesystem::path input_file; ///< as it was named
  Input input;
  bool quiet;
};

/// State in which a command left a run.
struct RunEnd
{
  bool was_interrupted; ///< something is left to be done
  std::string failure;  ///< of a part that could not be done, with its name; empty: none
  int code_of_failure = exit_code::user_error;
};

/// The part of a run that is its command's own. All processes that were started together make the run.
struct RunCommand
{
  std::string name; ///< lab, rve, multiscale
  /// Refuses, before any work, an input that cannot be run: throws InputError.
  std::function<void(const Input&, const std::filesystem::path& input_file)> check;
  /// Makes the rock, breaks it and reports, from wherever the folder stands.
  std::function<RunEnd(const Run&)> go;
};

/// The check of a folder with results that --force asks for (OutputFolder): no file that the run reads may be lost, nor a file
/// of the user. None without --force.
std::function<void(const std::filesystem::path& folder)> write_over(const CommonOptions& options, const Places& places,
                                                                    const Input& input);

/// Begins the run that the options want, or takes it up. Ctrl-C and SIGTERM, a full disk and the failure of a part leave
/// what is there, and a sentence tells how to go on; a mistake of the user in a run just begun leaves nothing. Returns the
/// exit code; throws InputError and OutputError.
int run_command(const RunCommand& command, const CommonOptions& options);

/// A run whose parts several processes can make, each its own.
struct SharedRun
{
  std::function<void(const Run&, Progress&)> share_out; ///< each process its parts, which it leaves in the folder
  std::function<RunEnd(const Run&, Progress&)>
    go_alone; ///< all parts that the folder does not have yet, and the report
};

/// Runs a command in the plane or in space, by all processes that were started together: the first takes up what all have
/// done, as after an interruption. Returns the exit code.
int run_shared(const std::string& name,
               const std::function<void(const Input&, const std::filesystem::path& input_file)>& check,
               const SharedRun& plane, const SharedRun& space, const CommonOptions& options);
} // namespace feldspar

#pragma once

#include "app/input/input.h"

#include <filesystem>
#include <string>
#include <vector>

namespace feldspar
{
/// The record of how a run was begun. It lies in the run's folder, which is therefore enough to continue it.
struct RunRecord
{
  Input input;
  std::filesystem::path input_file; ///< as it was named
  bool complete = false;            ///< nothing is left to be resumed
  std::string failure = {};         ///< of a complete run: which of its parts failed, and why; empty if none did
  int code_of_failure = 0;          ///< the exit code of the run, where there is a failure
  std::string remark = {};          ///< on an input file that has changed since and is not read; else empty
};

/// The files that an input names, in all its variants.
std::vector<std::filesystem::path> named_files(const Input& input);

/// Puts a copy of the input, where it came from, the settings in place of its entries, the command that reads it and the
/// checksums of all that it reads into the run's folder.
void write_run_record(const std::string& command, const Input& input, const std::filesystem::path& input_file,
                      const std::vector<std::string>& settings, const std::filesystem::path& folder);

/// The identity of a checkpoint of one part of a run: program, part and every parameter.
std::string run_identity(const Input& input, const std::string& part);

/// Notes that the run has come to its end, what of it failed, and the exit code of that.
void mark_complete(const std::filesystem::path& folder, const std::string& failure, int code_of_failure);

/// Throws InputError where the folder is not that of a run of this command, and where its input, or a file that it names, is
/// not what it was when the run began. `goes_on`: whether a complete run is read on from, too.
RunRecord read_run_record(const std::string& command, const std::filesystem::path& folder, bool goes_on = false);
} // namespace feldspar

#pragma once

#include "app/input.h"

#include <filesystem>

namespace feldspar
{
/// What a run's folder says of how it was begun, so that it can be taken up without anything else.
struct RunRecord
{
  Input input;
  std::filesystem::path input_file; ///< as it was named
  bool complete = false;            ///< nothing is left to be resumed
};

/// Puts a copy of the input, and where it came from, into the run's folder.
void write_run_record(const std::filesystem::path& input_file, const std::filesystem::path& folder);

/// Notes that the run has come to its end.
void mark_complete(const std::filesystem::path& folder);

/// Takes out whatever a run writes into its folder, and nothing else.
void remove_run(const std::filesystem::path& folder);

/// Throws InputError where the folder is not that of a run.
RunRecord read_run_record(const std::filesystem::path& folder);
} // namespace feldspar

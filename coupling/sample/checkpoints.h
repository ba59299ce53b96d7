#pragma once

#include "base/system/hdf5_archive.h"

#include <cstdint>
#include <filesystem>
#include <functional>
#include <string>
#include <vector>

/// Checkpoints of a test on any number of ranks, in a folder of their own:
///
///     step-0000000120/part-00000.h5, part-00001.h5, …   one a rank, whole or not there
///     step-0000000135/…                                  the last two steps are kept
///
/// A checkpoint appears under its name once all of its parts are written. Everything is collective.
namespace feldspar
{
/// Later ones are taken for those of a run that could not be gone on with, and removed. Throws OutputError; those before
/// are left as they were.
void write_checkpoint(const std::filesystem::path& folder, std::uint64_t step, const std::string& identity,
                      const std::function<void(Hdf5Writer&)>& write_part);

/// Calls `read_part` with part after part, each on one rank; with part 0 on the first rank. Throws InputError where one is
/// missing, torn, foreign or of another identity.
void read_checkpoint(const std::filesystem::path& checkpoint, const std::string& identity,
                     const std::function<void(Hdf5Reader&, std::uint64_t part)>& read_part);

/// The newest first.
std::vector<std::filesystem::path> checkpoints_in(const std::filesystem::path& folder);

} // namespace feldspar

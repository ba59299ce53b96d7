#pragma once

#include "base/system/hdf5_archive.h"

#include <filesystem>
#include <functional>
#include <string>

/// Checkpoints of a strain path, whichever solver goes the path.
namespace feldspar
{
void write_path_checkpoint(const std::filesystem::path& file, const std::string& identity,
                           const std::function<void(Hdf5Writer&)>& transfer);

/// Throws InputError where the file is damaged or has another identity.
void read_path_checkpoint(const std::filesystem::path& file, const std::string& identity,
                          const std::function<void(Hdf5Reader&)>& transfer);
} // namespace feldspar

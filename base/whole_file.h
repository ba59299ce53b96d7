#pragma once

#include <filesystem>
#include <functional>
#include <stdexcept>
#include <string_view>

namespace feldspar
{
/// A result cannot be kept: the disk is full, a quota is reached, the folder is gone. One line.
struct OutputError : std::runtime_error
{
  using std::runtime_error::runtime_error;
};

/// Writes a file whole or not at all, by way of a temporary one. Throws OutputError, which names file and cause.
void write_whole_file(const std::filesystem::path& file, std::string_view content);

/// The same where `fill` makes the temporary file, whose path it gets, and returns 0 or the error number of the system.
void write_whole_file(const std::filesystem::path& file, const std::function<int(const std::filesystem::path&)>& fill);
} // namespace feldspar

#pragma once

#include <cstdint>
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

/// Writes all of a content at a place of an open file. Returns 0 or the error number of the system, which streams of the
/// standard library do not tell.
int write_at(int descriptor, std::uint64_t place, std::string_view content);

/// Writes a file whole or not at all, by way of a temporary one that is new. A link in the place of either is replaced, never
/// followed. Throws OutputError, which names file and cause.
void write_whole_file(const std::filesystem::path& file, std::string_view content);

/// The same where `fill` writes the temporary file, which is empty and open for reading and writing, by its descriptor, and
/// returns 0 or the error number of the system.
void write_whole_file(const std::filesystem::path& file, const std::function<int(int descriptor)>& fill);

/// The same for a file that another library or program is about to write: takes away what lies in its place, so that nothing
/// is written through a link. Throws OutputError.
void make_way_for(const std::filesystem::path& file);

/// Calls `hear` with each file before this process writes it, from now on and one call at a time; an empty `hear` ends
/// this. A file for which `hear` throws is not written.
void hear_of_files(std::function<void(const std::filesystem::path& file)> hear);
} // namespace feldspar

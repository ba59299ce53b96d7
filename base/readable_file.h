#pragma once

#include <ext/stdio_filebuf.h>

#include <filesystem>
#include <istream>
#include <string>

/// Files to read from, and nothing else. A run reads its files more than once (it checks them, takes their checksum and
/// copies them), which a pipe does not allow; a pipe without a writer or a device would also keep it waiting for ever.
namespace feldspar
{
/// The reason why a file cannot be read, in the words that follow its name in a message: it is missing, a folder, a pipe, a
/// device. Empty if it can be.
std::string objection_to_reading(const std::filesystem::path& file);

/// A regular file as a stream, opened without waiting.
class ReadableFile : public std::istream
{
public:
  /// Throws InputError, which names file and reason.
  explicit ReadableFile(const std::filesystem::path& file);

private:
  __gnu_cxx::stdio_filebuf<char> buffer;
};

/// All bytes of a regular file. Throws InputError, which names file and reason.
std::string content_of(const std::filesystem::path& file);
} // namespace feldspar

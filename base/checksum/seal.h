#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <string_view>

/// The seal of a file: its length and a checksum (FNV-1a, 64 bits) after its content. HDF5 ignores bytes behind its own
/// end, so that a sealed file remains one for every other program; unlike the checksums of HDF5's arrays the seal covers
/// attributes and the library's own tables, whose damage HDF5 may react to with a crash.
namespace feldspar
{
/// Occurs in the content of every sealed file, so that a file which lost its seal is not taken for one that had none.
inline constexpr std::string_view seal_notice = "checksum_and_length_follow_the_content";

/// The bytes to append to a content.
std::string seal_of(std::string_view content);

/// Appends its seal to an open file, which is read a piece at a time. Returns 0 or the error number of the system.
int append_seal(int descriptor);

enum class Seal
{
  intact,
  broken,
  none ///< of an older version or of another program
};

/// Writes a small file of text with its seal, whole or not at all; `content` holds the notice. Throws OutputError.
void write_sealed(const std::filesystem::path& file, std::string_view content);

/// The content of a file that write_sealed() wrote; none where there is no file, or one without a seal, which is of an older
/// version. Throws InputError for a file whose content or seal was changed or cut.
std::optional<std::string> read_sealed(const std::filesystem::path& file);

/// Reads the whole file once, a piece at a time. A file that cannot be read is broken.
Seal examine_seal(const std::filesystem::path& file);
} // namespace feldspar

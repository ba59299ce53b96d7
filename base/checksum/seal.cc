#include "base/checksum/seal.h"

#include "base/checksum/fingerprint.h"
#include "base/input_error.h"
#include "base/readable_file.h"
#include "base/whole_file.h"

#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstdint>
#include <functional>
#include <istream>
#include <vector>

namespace feldspar
{
namespace
{
constexpr std::string_view mark = "\nfeldspar: seal\n";
constexpr std::size_t number_size = 8;
constexpr std::size_t seal_size = mark.size() + 2 * number_size;
constexpr std::size_t piece_size = std::size_t(1) << 20;

/// The lowest byte first, on every machine.
std::string bytes_of(const std::uint64_t number)
{
  std::string bytes;
  for (std::size_t i = 0; i < number_size; ++i)
    bytes += char(number >> (8 * i) & 0xffu);
  return bytes;
}

std::string seal(const std::uint64_t length, const Fingerprint& content)
{
  return std::string(mark) + bytes_of(length) + bytes_of(content.value());
}

/// `use` sees the first `length` bytes of a file piece by piece, until it returns false. False where they cannot be read.
bool for_each_piece(std::istream& file, std::uint64_t length, const std::function<bool(std::string_view)>& use)
{
  file.clear();
  file.seekg(0);
  std::string piece;
  while (length > 0)
    {
      piece.resize(std::min<std::uint64_t>(length, piece_size));
      if (!file.read(piece.data(), std::streamsize(piece.size())))
        return false;
      if (!use(piece))
        break;
      length -= piece.size();
    }
  return true;
}
} // namespace

std::string seal_of(const std::string_view content)
{
  Fingerprint print;
  print.add(content);
  return seal(content.size(), print);
}

int append_seal(const int descriptor)
{
  Fingerprint print;
  std::uint64_t length = 0;
  std::vector<char> piece(std::size_t(1) << 20);
  for (;;)
    {
      const ssize_t n = pread(descriptor, piece.data(), piece.size(), off_t(length));
      if (n < 0 && errno != EINTR)
        return errno;
      if (n == 0)
        break;
      if (n > 0)
        {
          print.add(std::string_view(piece.data(), std::size_t(n)));
          length += std::uint64_t(n);
        }
    }
  return write_at(descriptor, length, seal(length, print));
}

void write_sealed(const std::filesystem::path& file, const std::string_view content)
{
  write_whole_file(file, std::string(content) + seal_of(content));
}

std::optional<std::string> read_sealed(const std::filesystem::path& file)
{
  if (!std::filesystem::exists(file))
    return std::nullopt;
  const Seal seal = examine_seal(file);
  if (seal == Seal::broken)
    throw InputError("{}: damaged: content and checksum do not agree; remove this file and resume the run, which "
                     "computes anew what it kept",
                     file.string());
  if (seal == Seal::none)
    return std::nullopt;
  std::string content = content_of(file);
  content.resize(content.size() - seal_size);
  return content;
}

Seal examine_seal(const std::filesystem::path& path)
{
  if (!objection_to_reading(path).empty())
    return Seal::broken;
  ReadableFile file(path);
  const std::uint64_t size = std::filesystem::file_size(path);
  if (size >= seal_size)
    {
      const std::uint64_t length = size - seal_size;
      Fingerprint print;
      const bool could_be_read = for_each_piece(file, length, [&](const std::string_view piece) {
        print.add(piece);
        return true;
      });
      std::string end(seal_size, '\0');
      if (!could_be_read || !file.read(end.data(), seal_size))
        return Seal::broken;
      if (end == seal(length, print))
        return Seal::intact;
      if (end.starts_with(mark))
        return Seal::broken;
    }
  // No seal where one would be. The notice may lie across the border of two pieces.
  bool has_notice = false;
  std::string before;
  const bool could_be_read = for_each_piece(file, size, [&](const std::string_view piece) {
    before += piece;
    has_notice = before.find(seal_notice) != std::string::npos;
    before.erase(0, before.size() - std::min(before.size(), seal_notice.size()));
    return !has_notice;
  });
  return has_notice || !could_be_read ? Seal::broken : Seal::none;
}
} // namespace feldspar

#pragma once

#include <unistd.h>

#include <cerrno>
#include <cstdint>
#include <string_view>

namespace feldspar
{
/// Writes all of a content at a place of an open file. Returns 0 or the error number of the system, which streams of the
/// standard library do not tell.
inline int write_at(const int descriptor, std::uint64_t place, std::string_view content)
{
  while (!content.empty())
    if (const ssize_t n = pwrite(descriptor, content.data(), content.size(), off_t(place)); n >= 0)
      {
        content.remove_prefix(std::size_t(n));
        place += std::uint64_t(n);
      }
    else if (errno != EINTR)
      return errno;
  return 0;
}
} // namespace feldspar

#include "base/whole_file.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <unistd.h>

#include <cerrno>
#include <system_error>

namespace feldspar
{
namespace
{
/// 0, or the error number. Streams of the standard library do not tell the cause.
int write_all(const std::filesystem::path& file, std::string_view content)
{
  const int out = open(file.c_str(), O_WRONLY | O_CREAT | O_TRUNC | O_CLOEXEC, 0666);
  if (out < 0)
    return errno;
  int error = 0;
  while (!content.empty() && error == 0)
    if (const ssize_t n = write(out, content.data(), content.size()); n >= 0)
      content.remove_prefix(std::size_t(n));
    else if (errno != EINTR)
      error = errno;
  if (close(out) != 0 && error == 0)
    error = errno;
  return error;
}
} // namespace

void write_whole_file(const std::filesystem::path& file, const std::string_view content)
{
  write_whole_file(file, [&](const std::filesystem::path& unfinished) { return write_all(unfinished, content); });
}

void write_whole_file(const std::filesystem::path& file, const std::function<int(const std::filesystem::path&)>& fill)
{
  std::filesystem::path unfinished = file;
  unfinished += ".unfinished";
  const auto remove = [&] {
    std::error_code ignored;
    std::filesystem::remove(unfinished, ignored);
  };
  std::error_code error;
  try
    {
      error.assign(fill(unfinished), std::generic_category());
    }
  catch (...)
    {
      remove();
      throw;
    }
  if (!error)
    std::filesystem::rename(unfinished, file, error);
  if (error)
    {
      remove();
      throw OutputError(fmt::format("{}: cannot be written: {}", file.string(), error.message()));
    }
}
} // namespace feldspar

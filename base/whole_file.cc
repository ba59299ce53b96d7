#include "base/whole_file.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <unistd.h>

#include <cerrno>
#include <mutex>
#include <system_error>
#include <utility>

namespace feldspar
{
namespace
{
std::mutex telling;
std::function<void(const std::filesystem::path&)> listener; // of the process

void tell(const std::filesystem::path& file)
{
  const std::lock_guard lock(telling);
  if (listener)
    listener(file);
}

OutputError cannot_be_written(const std::filesystem::path& file, const std::string& why)
{
  return OutputError(fmt::format("{}: cannot be written: {}", file.string(), why));
}

/// Takes away what lies in the place of a temporary file, which a killed run may have left, and opens a new one; a link that
/// lies there is not followed. Returns the descriptor, or -1 with errno.
int open_new(const std::filesystem::path& file)
{
  if (unlink(file.c_str()) != 0 && errno != ENOENT)
    return -1;
  return open(file.c_str(), O_RDWR | O_CREAT | O_EXCL | O_NOFOLLOW | O_CLOEXEC, 0666);
}
} // namespace

int write_at(const int descriptor, std::uint64_t place, std::string_view content)
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

void write_whole_file(const std::filesystem::path& file, const std::string_view content)
{
  write_whole_file(file, [&](const int descriptor) { return write_at(descriptor, 0, content); });
}

void write_whole_file(const std::filesystem::path& file, const std::function<int(int)>& fill)
{
  tell(file);
  std::filesystem::path unfinished = file;
  unfinished += ".unfinished";
  const auto remove = [&] {
    std::error_code ignored;
    std::filesystem::remove(unfinished, ignored);
  };
  const int descriptor = open_new(unfinished);
  int problem = descriptor < 0 ? errno : 0;
  if (problem == 0)
    {
      try
        {
          problem = fill(descriptor);
        }
      catch (...)
        {
          close(descriptor);
          remove();
          throw;
        }
      if (close(descriptor) != 0 && problem == 0)
        problem = errno;
    }
  std::error_code error(problem, std::generic_category());
  if (!error)
    std::filesystem::rename(unfinished, file, error);
  if (error)
    {
      remove();
      throw cannot_be_written(file, error.message());
    }
}

void make_way_for(const std::filesystem::path& file)
{
  tell(file);
  if (unlink(file.c_str()) != 0 && errno != ENOENT)
    throw cannot_be_written(file, std::generic_category().message(errno));
}

void hear_of_files(std::function<void(const std::filesystem::path&)> hear)
{
  const std::lock_guard lock(telling);
  listener = std::move(hear);
}
} // namespace feldspar

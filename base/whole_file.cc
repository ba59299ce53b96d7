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
struct Listener
{
  std::mutex mutex;
  std::function<void(const std::filesystem::path&)> hear;
};

Listener& listener()
{
  static Listener of_process;
  return of_process;
}

void tell(const std::filesystem::path& file)
{
  Listener& of_process = listener();
  const std::lock_guard lock(of_process.mutex);
  if (of_process.hear)
    of_process.hear(file);
}

OutputError cannot_be_written(const std::filesystem::path& file, const std::string& why)
{
  return OutputError(fmt::format("{}: cannot be written: {}", file.string(), why));
}

/// 0, or the error number. Streams of the standard library do not tell the cause.
int write_all(const std::filesystem::path& file, std::string_view content)
{
  // A killed run may have left one; a link that lies there is not followed.
  if (unlink(file.c_str()) != 0 && errno != ENOENT)
    return errno;
  const int out = open(file.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_NOFOLLOW | O_CLOEXEC, 0666);
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
  tell(file);
  std::filesystem::path unfinished = file;
  unfinished += ".unfinished";
  std::error_code error(write_all(unfinished, content), std::generic_category());
  if (!error)
    std::filesystem::rename(unfinished, file, error);
  if (error)
    {
      std::error_code ignored;
      std::filesystem::remove(unfinished, ignored);
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
  Listener& of_process = listener();
  const std::lock_guard lock(of_process.mutex);
  of_process.hear = std::move(hear);
}
} // namespace feldspar

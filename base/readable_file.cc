#include "base/readable_file.h"

#include "base/input_error.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <iterator>
#include <system_error>

namespace feldspar
{
namespace
{
std::string cannot_be_read(const int error)
{
  return fmt::format("cannot be read: {}", std::generic_category().message(error));
}

std::string objection_to_kind(const mode_t mode)
{
  constexpr const char* instead =
    "write its content into a file and name that, as a run reads its files more than once";
  if (S_ISREG(mode))
    return "";
  if (S_ISDIR(mode))
    return "is a folder; a file is needed";
  if (S_ISFIFO(mode))
    return fmt::format("is a pipe; {}", instead);
  return fmt::format("is a {}; {}", S_ISSOCK(mode) ? "socket" : "device", instead);
}

/// Checks the name first, as opening some devices does something. An open file is checked once more: its name may have
/// become another's meanwhile.
int open_regular(const std::filesystem::path& file)
{
  std::string objection = objection_to_reading(file);
  const int descriptor = objection.empty() ? open(file.c_str(), O_RDONLY | O_NONBLOCK | O_NOCTTY | O_CLOEXEC) : -1;
  struct stat opened = {};
  if (objection.empty())
    objection =
      descriptor < 0 || fstat(descriptor, &opened) != 0 ? cannot_be_read(errno) : objection_to_kind(opened.st_mode);
  if (objection.empty())
    return descriptor;
  if (descriptor >= 0)
    close(descriptor);
  throw InputError("{}: {}", file.string(), objection);
}
} // namespace

std::string objection_to_reading(const std::filesystem::path& file)
{
  struct stat found = {};
  if (stat(file.c_str(), &found) != 0)
    return cannot_be_read(errno);
  if (const std::string objection = objection_to_kind(found.st_mode); !objection.empty())
    return objection;
  return access(file.c_str(), R_OK) == 0 ? "" : cannot_be_read(errno);
}

ReadableFile::ReadableFile(const std::filesystem::path& file)
  : std::istream(nullptr)
  , buffer(open_regular(file), std::ios::in | std::ios::binary)
{
  rdbuf(&buffer);
}

std::string content_of(const std::filesystem::path& file)
{
  ReadableFile stream(file);
  return {std::istreambuf_iterator<char>(stream), {}};
}
} // namespace feldspar

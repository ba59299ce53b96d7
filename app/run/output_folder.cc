#include "app/run/output_folder.h"

#include "app/run/file_list.h"
#include "base/input_error.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <system_error>

namespace feldspar
{
namespace
{
InputError cannot_write(const std::filesystem::path& folder, const int error)
{
  return InputError("{}: cannot be written into: {}; choose another folder with --output", folder.string(),
                    std::generic_category().message(error));
}
} // namespace

OutputFolder::OutputFolder(const std::optional<std::filesystem::path>& wanted, const std::filesystem::path& input,
                           const std::function<void(const std::filesystem::path&)>& write_over)
  : OutputFolder() // so that a folder which was made goes again where the rest throws
{
  if (wanted)
    make_wanted(*wanted, write_over);
  else
    for (unsigned int number = 1; made.empty(); ++number)
      {
        folder = input.parent_path() / fmt::format("{}-results-{:03}", input.stem().string(), number);
        make(folder);
      }
}

OutputFolder::~OutputFolder()
{
  for (auto last = made.rbegin(); last != made.rend(); ++last)
    rmdir(last->c_str()); // which keeps a folder with something in it
}

bool OutputFolder::make(const std::filesystem::path& new_folder)
{
  if (mkdir(new_folder.c_str(), 0777) == 0)
    {
      made.push_back(new_folder);
      return true;
    }
  if (errno != EEXIST)
    throw cannot_write(new_folder, errno);
  return false;
}

void OutputFolder::make_wanted(const std::filesystem::path& wanted,
                               const std::function<void(const std::filesystem::path&)>& write_over)
{
  folder = wanted.has_filename() ? wanted : wanted.parent_path(); // without a slash at the end
  std::filesystem::path parent;
  bool is_new = false;
  for (const std::filesystem::path& part : folder)
    {
      parent /= part;
      is_new = make(parent);
    }
  if (is_new)
    return;
  if (!std::filesystem::is_directory(folder))
    throw cannot_write(folder, ENOTDIR);
  if (access(folder.c_str(), W_OK | X_OK) != 0)
    throw cannot_write(folder, errno);
  if (std::filesystem::is_empty(folder))
    return;
  if (!write_over)
    throw InputError("{}: is not empty; choose another folder with --output, or leave --output out for a new one{}",
                     folder.string(),
                     holds_a_run(folder) ? " (--force replaces the run in it, and keeps all other files)" : "");
  write_over(folder);
}

FolderLock::FolderLock(const std::filesystem::path& folder)
  : descriptor((check_links(folder), open(folder.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC)))
{
  if (descriptor >= 0 && flock(descriptor, LOCK_EX | LOCK_NB) != 0 && errno == EWOULDBLOCK)
    {
      close(descriptor);
      throw InputError("{}: another feldspar works in this folder; wait for its end, or choose another",
                       folder.string());
    }
}

FolderLock::~FolderLock()
{
  if (descriptor >= 0)
    close(descriptor);
}
} // namespace feldspar

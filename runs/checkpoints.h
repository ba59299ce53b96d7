#pragma once

#include "base/input_error.h"
#include <fmt/format.h>

#include <filesystem>
#include <string>
#include <utility>
#include <vector>

namespace feldspar
{
/// The part as the first of these checkpoints that can be used has it, newest first, else as `begin` makes it. `read` puts
/// it into the state of a file. `tell` hears, in a sentence, of one that cannot be used.
template <typename Begin, typename Read, typename Tell>
auto last_good(const std::vector<std::filesystem::path>& checkpoints, const Begin& begin, const Read& read,
               const Tell& tell)
{
  for (std::size_t k = 0; k < checkpoints.size(); ++k)
    if (std::filesystem::exists(checkpoints[k]))
      try
        {
          auto part = begin();
          read(part, checkpoints[k]);
          return part;
        }
      catch (const InputError& error)
        {
          const bool has_older = k + 1 < checkpoints.size() && std::filesystem::exists(checkpoints[k + 1]);
          tell(fmt::format("{}; going back to the {}", error.what(), has_older ? "checkpoint before it" : "start"));
        }
  return begin();
}

/// The last two checkpoints of one part of a run: a test, a path.
class Checkpoints
{
public:
  /// `identity`: of the program, the input and the part; a checkpoint of another one is not resumed from.
  Checkpoints(const std::filesystem::path& folder, const std::string& name, std::string its_identity)
    : newest(folder / (name + ".h5"))
    , one_before(folder / (name + ".previous.h5"))
    , identity(std::move(its_identity))
  {
  }

  /// Throws OutputError; the one before is then still there.
  template <typename Part>
  void write(Part&& part) const
  {
    set_newest_aside();
    write_newest(part);
  }
  void set_newest_aside() const
  {
    if (newest_is_good && std::filesystem::exists(newest))
      std::filesystem::rename(newest, one_before);
    newest_is_good = true;
  }
  template <typename Part>
  void write_newest(Part&& part) const
  {
    part.write_checkpoint(newest, identity);
  }

  /// The part as its last good checkpoint has it, else from the start, where `begin` puts it. `tell` as of last_good().
  template <typename Begin, typename Tell>
  auto open(const Begin& begin, const Tell& tell) const
  {
    return last_good(
      {newest, one_before}, begin,
      [&](auto& part, const std::filesystem::path& file) {
        part.read_checkpoint(file, identity);
        newest_is_good = file == newest;
      },
      tell);
  }

private:
  std::filesystem::path newest;
  std::filesystem::path one_before;
  std::string identity;
  mutable bool newest_is_good = true; ///< else the one before was taken up, and stays
};
} // namespace feldspar

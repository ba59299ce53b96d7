#include "coupling/sample/checkpoints.h"

#include "base/parameter_id.h"
#include "base/ranks/ranks.h"
#include "base/whole_file.h"

#include <algorithm>
#include <system_error>

namespace feldspar
{
namespace
{
std::filesystem::path part_file(const std::filesystem::path& checkpoint, const std::uint64_t part)
{
  return checkpoint / fmt::format("part-{:05}.h5", part);
}

std::vector<std::filesystem::path> listed(const std::filesystem::path& folder)
{
  std::vector<std::filesystem::path> found;
  if (std::filesystem::is_directory(folder))
    for (const auto& entry : std::filesystem::directory_iterator(folder))
      if (entry.path().filename().string().starts_with("step-"))
        found.push_back(entry.path());
  std::sort(found.rbegin(), found.rend()); // names are of equal length
  return found;
}
} // namespace

void write_checkpoint(const std::filesystem::path& folder, const std::uint64_t step, const std::string& identity,
                      const std::function<void(Hdf5Writer&)>& write_part)
{
  const auto unfinished = folder / "unfinished";
  const auto checkpoint = folder / fmt::format("step-{:010}", step);
  try
    {
      ranks::first([&] {
        std::filesystem::remove_all(unfinished); // of a run that was killed
        std::filesystem::create_directories(unfinished);
      });
      ranks::together([&] {
        write_hdf5(part_file(unfinished, ranks::mine()), [&](Hdf5Writer& root) {
          std::string of_run = identity;
          root.text("identity", of_run);
          std::uint64_t its_step = step;
          root.value("step", its_step);
          std::uint64_t n_parts = ranks::number();
          root.value("n_parts", n_parts);
          write_part(root);
        });
      });
      ranks::first([&] {
        std::filesystem::remove_all(checkpoint); // as the same step may have another end
        std::filesystem::rename(unfinished, checkpoint);
        constexpr int n_kept = 2;
        int n = 0;
        for (const auto& other : listed(folder))
          if (other > checkpoint || ++n > n_kept)
            std::filesystem::remove_all(other);
      });
    }
  catch (const OutputError& error)
    {
      std::vector<std::filesystem::path> left;
      ranks::first([&] {
        std::error_code ignored;
        std::filesystem::remove_all(unfinished, ignored);
        left = listed(folder);
      });
      const std::string kept = ranks::of_first(left.empty() ? "" : "; what is kept is " + left.front().string());
      throw OutputError(error.what() + kept);
    }
}

void read_checkpoint(const std::filesystem::path& checkpoint, const std::string& identity,
                     const std::function<void(Hdf5Reader&, std::uint64_t)>& read_part)
{
  const std::string expected = "a checkpoint of " + in_words(Work::sample);
  std::uint64_t n_parts = 0;
  ranks::first(
    [&] { read_hdf5(part_file(checkpoint, 0), expected, [&](Hdf5Reader& root) { root.value("n_parts", n_parts); }); });
  n_parts = std::stoull(ranks::of_first(std::to_string(n_parts)));
  ranks::together([&] {
    for (std::uint64_t part = ranks::mine(); part < n_parts; part += ranks::number())
      read_hdf5(part_file(checkpoint, part), expected, [&](Hdf5Reader& root) {
        std::string of_run;
        root.text("identity", of_run);
        if (of_run != identity)
          throw InputError("of another test, input or version of this program");
        read_part(root, part);
      });
  });
}

std::vector<std::filesystem::path> checkpoints_in(const std::filesystem::path& folder)
{
  std::string names;
  ranks::first([&] {
    for (const auto& checkpoint : listed(folder))
      names += checkpoint.filename().string() + '\n';
  });
  names = ranks::of_first(names);
  std::vector<std::filesystem::path> all;
  for (std::size_t begin = 0; begin < names.size(); begin = names.find('\n', begin) + 1)
    all.push_back(folder / names.substr(begin, names.find('\n', begin) - begin));
  return all;
}

} // namespace feldspar

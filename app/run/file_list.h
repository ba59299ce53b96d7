#pragma once

#include <filesystem>
#include <set>
#include <string>
#include <string_view>
#include <vector>

/// The files that runs wrote into a folder. Whatever else lies there belongs to the user, and no run takes it away.
namespace feldspar
{
/// Names that a command writes into its folder.
struct Places
{
  std::vector<std::string_view> files;
  std::vector<std::string_view> folders; ///< with all that is in them
  bool specimens;                        ///< specimen.h5, specimen_seed_1.h5, ...

  /// Whether a path relative to the folder is one of these files, or lies in one of these folders.
  bool include(const std::filesystem::path& relative) const;
};

const Places& places_of_runs(); ///< of lab, rve, multiscale, calibrate
const Places& places_of_specimens();
const Places& places_of_contacts();
const Places& places_of_reports();

/// Keeps a list of the files that this process writes into a folder: each is listed before it is written. The list lies
/// in the folder, and the next process there adds to it.
class FileList
{
public:
  explicit FileList(const std::filesystem::path& folder);
  FileList(const FileList&) = delete;
  FileList& operator=(const FileList&) = delete;
  ~FileList();

private:
  void note(const std::filesystem::path& file);

  std::filesystem::path folder;
  std::set<std::string> known;
  int list = -1; ///< its descriptor; opened with the first file
};

/// Refuses a folder in which a folder of results is a link: what is written into that would lie elsewhere. Throws InputError.
void check_links(const std::filesystem::path& folder);

/// Refuses to write over the folder of an earlier run where that would cost a file of the user: one that this run reads
/// (`inputs`: files and folders), or one in a place of results that no run wrote. Throws InputError.
void check_write_over(const std::filesystem::path& folder, const Places& places,
                      const std::vector<std::filesystem::path>& inputs);

/// Whether a run has written into the folder.
bool holds_a_run(const std::filesystem::path& folder);

/// Removes the files that runs wrote into the folder and whose path begins with `below`, and the folders of results
/// that are then empty. Where `below` is empty, it removes all files of runs, and their list too.
void remove_listed_files(const std::filesystem::path& folder, const std::string& below = "");
} // namespace feldspar

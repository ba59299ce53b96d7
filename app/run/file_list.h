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

  /// Returns whether a path relative to the folder is one of these files, or lies in one of these folders.
  bool include(const std::filesystem::path& relative) const;
};

extern const Places places_of_runs; ///< of lab, rve, multiscale, calibrate
extern const Places places_of_specimens, places_of_contacts, places_of_reports;

/// Keeps a list of the files that this process writes into a folder: each is listed before it is written. The list lies
/// in the folder, and the next process there adds to it. A file in the place of a result that no run wrote is moved aside and
/// said.
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
  bool all_results_are_known; ///< not where a version without lists wrote
  int list = -1;              ///< its descriptor; opened with the first file
};

/// Refuses a folder in which a folder of results is a link, so that what is written into it would lie elsewhere, or is a file.
/// Throws InputError.
void check_links(const std::filesystem::path& folder);

/// Refuses to write over the folder of an earlier run where that would cost a file of the user: one that this run reads
/// (`inputs`: files and folders), or one in a place of results that no run wrote. Throws InputError.
void check_write_over(const std::filesystem::path& folder, const Places& places,
                      const std::vector<std::filesystem::path>& inputs);

/// Returns whether a run has written into the folder.
bool holds_a_run(const std::filesystem::path& folder);

/// Removes the files that runs wrote into the folder and whose path begins with `below`, and the folders of results
/// that are then empty. Where `below` is empty, it removes all files of runs, and their list too.
void remove_listed_files(const std::filesystem::path& folder, const std::string& below = "");

/// The results of an earlier run that another one replaces. They wait aside until that run is known to be possible.
class EarlierRun
{
public:
  /// Puts them aside, in a folder of its own within `folder`.
  explicit EarlierRun(const std::filesystem::path& folder);
  EarlierRun(const EarlierRun&) = delete;
  EarlierRun& operator=(const EarlierRun&) = delete;
  /// Removes them.
  ~EarlierRun();

  /// Puts them back, once all files of the other run are removed.
  void restore();

private:
  std::filesystem::path folder;
};

/// Removes what a killed run has left aside.
void forget_earlier_run(const std::filesystem::path& folder);
} // namespace feldspar

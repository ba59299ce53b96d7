#pragma once

#include <filesystem>
#include <functional>
#include <optional>
#include <vector>

namespace feldspar
{
/// The folder a run writes into. It is made at construction, so that a run does not find out after hours that it
/// cannot write; one that stays empty goes again, so that a run which ends before its first result leaves nothing.
class OutputFolder
{
public:
  /// Without `wanted`, a fresh numbered folder beside the input: NAME-results-001, …. With it, that one, its parents
  /// made too; if something is in it already, `write_over` must be there: it throws InputError where it objects to
  /// results in the folder. Throws InputError.
  OutputFolder(const std::optional<std::filesystem::path>& wanted, const std::filesystem::path& input,
               const std::function<void(const std::filesystem::path& folder)>& write_over);
  OutputFolder(const OutputFolder&) = delete;
  OutputFolder& operator=(const OutputFolder&) = delete;
  ~OutputFolder();

  const std::filesystem::path& path() const { return folder; }

private:
  OutputFolder() = default;

  /// Makes a folder. Returns whether it was made now; false if it is there already. One of several runs that try at
  /// once makes it.
  bool make(const std::filesystem::path& new_folder);
  void make_wanted(const std::filesystem::path& wanted,
                   const std::function<void(const std::filesystem::path& folder)>& write_over);

  std::filesystem::path folder;
  std::vector<std::filesystem::path> made;
};

/// Keeps a folder to one run as long as it lives. The lock is of the process: it goes with it, however it ends.
class FolderLock
{
public:
  /// Throws InputError where another run has the folder, and where links lead out of it (check_links). A file system
  /// without locks grants every one.
  explicit FolderLock(const std::filesystem::path& folder);
  FolderLock(const FolderLock&) = delete;
  FolderLock& operator=(const FolderLock&) = delete;
  ~FolderLock();

private:
  int descriptor;
};
} // namespace feldspar

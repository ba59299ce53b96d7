#include "app/run/file_list.h"

#include "base/contains.h"
#include "base/input_error.h"
#include "base/quoted.h"
#include "base/readable_file.h"
#include "base/whole_file.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <exception>
#include <iterator>
#include <regex>
#include <sstream>
#include <system_error>

namespace feldspar
{
namespace
{
namespace fs = std::filesystem;

constexpr const char* list_name = ".feldspar-files";
constexpr const char* earlier_name = ".feldspar-before";
constexpr const char* record_name = "run.json";
constexpr const char* page_name = "report.html";
constexpr const char* film_name = "film.webp";

bool is_specimen(const std::string& name) { return name.starts_with("specimen") && name.ends_with(".h5"); }

/// Says whether every run of one rock may write this name of a specimen: specimen.h5, specimen_seed_1.h5.
bool is_usual_specimen(const std::string& name)
{
  static const std::regex usual("specimen(_seed_[0-9]+)?\\.h5");
  return std::regex_match(name, usual);
}

bool is_there(const fs::path& file)
{
  std::error_code ignored;
  return fs::exists(fs::symlink_status(file, ignored));
}

/// Path as it is compared: from the root, without `.`, `..` and slashes at its end.
fs::path plain(const fs::path& path)
{
  const fs::path normal = fs::absolute(path).lexically_normal();
  return normal.has_filename() ? normal : normal.parent_path();
}

/// The path of a file relative to a folder; empty where the file does not lie below the folder.
fs::path relative_to(const fs::path& folder, const fs::path& file)
{
  const fs::path relative = file.lexically_relative(folder);
  return relative.empty() || *relative.begin() == ".." || relative == "." ? fs::path() : relative;
}

/// The list as it stands. It may be that of somebody else: only places of results count.
std::set<std::string> listed_files(const fs::path& folder)
{
  std::set<std::string> files;
  if (!is_there(folder / list_name))
    return files;
  std::istringstream lines(content_of(folder / list_name));
  for (std::string line; std::getline(lines, line);)
    {
      const fs::path file = line;
      const bool is_plain =
        !line.empty() && file.is_relative() && file.lexically_normal() == file && file.has_filename();
      if (is_plain && (places_of_runs.include(file) || places_of_contacts.include(file)))
        files.insert(line);
    }
  return files;
}

/// Returns whether no folder on the way to the file is a link.
bool lies_in(const fs::path& folder, const fs::path& relative)
{
  fs::path way = folder;
  for (const fs::path& part : relative.parent_path())
    if (way /= part; fs::is_symlink(fs::symlink_status(way)))
      return false;
  return true;
}

/// Takes out a file or a link; a folder in its place is somebody else's.
void remove_file(const fs::path& file)
{
  std::error_code error;
  if (!fs::is_directory(fs::symlink_status(file)) && !fs::remove(file, error) && error)
    throw OutputError(fmt::format("{}: cannot be removed: {}", file.string(), error.message()));
}

/// A listed file, what a killed run began of it, and the names that checkpoints get later: NAME.h5 becomes
/// NAME.previous.h5, unfinished/part-00000.h5 becomes step-0000000001/part-00000.h5.
std::vector<fs::path> with_later_names(const fs::path& file)
{
  std::vector<fs::path> files{file, fs::path(file) += ".unfinished"};
  if (file.parent_path().filename() == "checkpoints" && file.extension() == ".h5")
    files.push_back(fs::path(file).replace_extension(".previous.h5"));
  const fs::path steps = file.parent_path().parent_path();
  if (file.parent_path().filename() == "unfinished" && fs::is_directory(steps))
    for (const auto& entry : fs::directory_iterator(steps))
      if (entry.path().filename().string().starts_with("step-") && !entry.is_symlink())
        files.push_back(entry.path() / file.filename());
  return files;
}

/// Moves what lies in the place of a result that no run wrote to a free name beside it.
void keep_aside(const fs::path& file)
{
  fs::path free = fs::path(file) += ".kept";
  for (unsigned int number = 2; is_there(free); ++number)
    free = fs::path(file) += fmt::format(".kept-{}", number);
  std::error_code error;
  fs::rename(file, free, error);
  if (error)
    throw OutputError(fmt::format("{}: no run wrote it, and it cannot be moved to {}: {}", file.string(),
                                  free.filename().string(), error.message()));
  static unsigned int n_kept = 0;
  constexpr unsigned int most_said = 3;
  if (++n_kept <= most_said)
    fmt::print(stderr, "feldspar: {}: no run is known to have written it; it is kept as {}{}\n",
               printable(file.string()), printable(free.filename().string()),
               n_kept == most_said ? ", further ones likewise" : "");
}

/// Removes the empty folders of a tree, the innermost first.
void remove_empty_folders(const fs::path& folder)
{
  if (!fs::is_directory(fs::symlink_status(folder)))
    return;
  std::vector<fs::path> folders{folder};
  for (const auto& entry : fs::recursive_directory_iterator(folder))
    if (entry.is_directory() && !entry.is_symlink())
      folders.push_back(entry.path());
  for (auto one = folders.rbegin(); one != folders.rend(); ++one)
    rmdir(one->c_str());
}

bool has_words(const fs::path& file, const std::string_view words)
{
  return objection_to_reading(file).empty() && content_of(file).find(words) != std::string::npos;
}

/// Says whether a run of a version without lists wrote the folder.
bool is_of_version_without_lists(const fs::path& folder)
{
  return !is_there(folder / list_name) &&
         (has_words(folder / record_name, "\"relative_to\"") || has_words(folder / page_name, "Feldspar report of"));
}

/// The files that runs wrote into the folder. A folder of a version without lists gives only the known names at its
/// top: files in its folders of results may be the user's.
std::set<std::string> files_of_runs(const fs::path& folder)
{
  std::set<std::string> files = listed_files(folder);
  if (!is_of_version_without_lists(folder))
    return files;
  const bool is_run = has_words(folder / record_name, "\"relative_to\"");
  const Places& places = is_run ? places_of_runs : places_of_reports;
  for (const auto& entry : fs::directory_iterator(folder))
    if (const std::string name = entry.path().filename().string();
        places.include(name) && !contains(places.folders, name))
      files.insert(name);
  return files;
}

/// Moves the files of a run, and their list.
void move_run(const std::set<std::string>& files, const fs::path& from, const fs::path& to)
{
  const auto move_one = [&](const fs::path& file) {
    const fs::path target = to / file.lexically_relative(from);
    fs::create_directories(target.parent_path());
    if (is_there(file) && !fs::is_directory(fs::symlink_status(file)))
      fs::rename(file, target);
  };
  for (const std::string& file : files)
    if (lies_in(from, file))
      for (const fs::path& one : with_later_names(from / file))
        move_one(one);
  move_one(from / list_name); // the last one: until then it says what is where
  for (const std::string_view name : places_of_runs.folders)
    remove_empty_folders(from / name);
}
} // namespace

bool Places::include(const std::filesystem::path& relative) const
{
  const std::string first = relative.begin()->string();
  const bool is_at_top = std::next(relative.begin()) == relative.end();
  return contains(folders, first) || (is_at_top && (contains(files, first) || (specimens && is_specimen(first))));
}

const Places places_of_runs{{record_name, "input.prm", "input.json", "summary.json", "tests.csv", "cracks.csv",
                             "emission.csv", "minerals.csv", "steps.csv", "reference.json", page_name, film_name,
                             "log.txt", "calibration.json", "design.csv", "posterior.csv", "best.prm", "nearest.prm"},
                            {"checkpoints", "curves", "grains", "fields", "points", "rves", "states", "extracted",
                             "figures", "tables", "quakeml", "calibration", "volumes" /* of 0.2.0, now rves */},
                            true};
const Places places_of_specimens{{}, {"packings"}, true};
const Places places_of_contacts{{"contact.csv"}, {}, false};
const Places places_of_reports{{page_name, film_name}, {"figures", "tables", "quakeml"}, false};

FileList::FileList(const std::filesystem::path& its_folder)
  : folder(plain(its_folder))
  , known(listed_files(folder))
  , all_results_are_known(!is_of_version_without_lists(folder))
{
  hear_of_files([this](const fs::path& file) { note(file); });
}

FileList::~FileList()
{
  hear_of_files({});
  if (list < 0)
    return;
  close(list);
  // A run that ends before its first result leaves nothing.
  if (std::ranges::none_of(known, [&](const std::string& file) { return is_there(folder / file); }))
    unlink((folder / list_name).c_str());
}

void FileList::note(const std::filesystem::path& file)
{
  const fs::path relative = relative_to(folder, plain(file));
  if (relative.empty() || known.contains(relative.string()))
    return;
  // Another process of this run may have listed it since this one read the list.
  if (all_results_are_known && is_there(folder / relative) && !listed_files(folder).contains(relative.string()))
    keep_aside(folder / relative);
  std::string lines;
  if (list < 0)
    {
      if (is_there(folder / list_name))
        lines = "\n"; // a killed run may have left half a line
      else
        for (const std::string& of_version_without_lists : known = files_of_runs(folder))
          lines += of_version_without_lists + "\n";
      list =
        open((folder / list_name).c_str(), O_WRONLY | O_APPEND | O_CREAT | O_NOFOLLOW | O_NONBLOCK | O_CLOEXEC, 0666);
    }
  lines += relative.string() + "\n";
  if (list < 0 || write(list, lines.data(), lines.size()) != ssize_t(lines.size()))
    throw OutputError(
      fmt::format("{}: cannot be written: {}", (folder / list_name).string(), std::generic_category().message(errno)));
  known.insert(relative.string());
}

void check_links(const std::filesystem::path& folder)
{
  const auto refuse = [](const fs::path& link) {
    throw InputError("{}: is a link to another folder, into which results would be written; remove it, or "
                     "copy the folder there",
                     link.string());
  };
  if (fs::is_symlink(fs::symlink_status(folder / list_name)))
    throw InputError("{}: is a link; the list of the files that runs wrote is to be a file: remove it",
                     (folder / list_name).string());
  for (const std::string_view name : places_of_runs.folders)
    {
      const fs::path own = folder / name;
      if (fs::is_symlink(fs::symlink_status(own)))
        refuse(own);
      if (is_there(own) && !fs::is_directory(own))
        throw InputError("{}: is a file, where a folder of results is to be; move it elsewhere", own.string());
      if (fs::is_directory(own))
        for (const auto& entry : fs::recursive_directory_iterator(own))
          if (entry.is_symlink() && entry.is_directory())
            refuse(entry.path());
    }
}

void check_write_over(const std::filesystem::path& folder, const Places& places,
                      const std::vector<std::filesystem::path>& inputs)
{
  const std::set<std::string> of_runs = files_of_runs(folder);
  const auto would_go = [&](const fs::path& relative) {
    return !relative.empty() && (places.include(relative) || of_runs.contains(relative.string()));
  };
  const fs::path whole = fs::canonical(folder);
  for (const fs::path& input : inputs)
    {
      // The name itself may be a link out of the folder, or one into it.
      std::error_code ignored;
      const fs::path named = fs::weakly_canonical(plain(input).parent_path(), ignored) / plain(input).filename();
      const fs::path meant = fs::weakly_canonical(named, ignored);
      if (meant == whole || would_go(relative_to(whole, named)) || would_go(relative_to(whole, meant)))
        throw InputError("--force: {} is read by this run and lies among the results in {} that it would "
                         "replace; choose another folder with --output",
                         input.string(), folder.string());
    }
  for (const auto& entry : fs::directory_iterator(folder))
    if (const std::string name = entry.path().filename().string();
        places.include(name) && !contains(places.folders, name) && !of_runs.contains(name) &&
        (!is_specimen(name) || is_usual_specimen(name)))
      throw InputError("--force: no run is known to have written {}, which this one would replace; move it "
                       "elsewhere, or choose another folder with --output",
                       (folder / name).string());
}

bool holds_a_run(const std::filesystem::path& folder) { return !files_of_runs(folder).empty(); }

void remove_listed_files(const std::filesystem::path& folder, const std::string& below)
{
  for (const std::string& file : files_of_runs(folder))
    if (file.starts_with(below) && lies_in(folder, file))
      for (const fs::path& one : with_later_names(folder / file))
        remove_file(one);
  for (const std::string_view name : places_of_runs.folders)
    if (name.starts_with(below.substr(0, below.find('/'))))
      remove_empty_folders(folder / name);
  if (below.empty())
    remove_file(folder / list_name);
}

EarlierRun::EarlierRun(const std::filesystem::path& its_folder)
  : folder(its_folder)
{
  forget_earlier_run(folder);
  const std::set<std::string> files = files_of_runs(folder);
  if (!files.empty() && !fs::is_symlink(fs::symlink_status(folder / earlier_name)))
    move_run(files, folder, folder / earlier_name);
}

void EarlierRun::restore() { move_run(files_of_runs(folder / earlier_name), folder / earlier_name, folder); }

EarlierRun::~EarlierRun()
{
  try
    {
      forget_earlier_run(folder);
    }
  catch (const std::exception&)
    {
      // A file that cannot be removed stays aside; the next run with --force tries again.
    }
}

void forget_earlier_run(const std::filesystem::path& folder)
{
  const fs::path earlier = folder / earlier_name;
  if (!fs::is_directory(fs::symlink_status(earlier)))
    return;
  remove_listed_files(earlier);
  rmdir(earlier.c_str());
}
} // namespace feldspar

#include "app/run/run.h"

#include "app/processes/mpi_session.h"
#include "app/run/interrupt.h"
#include "app/run/output_folder.h"
#include "app/run/run_record.h"
#include "app/screen/print_result.h"
#include "base/input_error.h"
#include "base/quoted.h"
#include "base/ranks/ranks.h"
#include "base/whole_file.h"
#include "dem/genesis/packing_file.h"
#include "dem/specimen/specimen_file.h"
#include "runs/share_out.h"

#include <fmt/format.h>

#include <cstdio>
#include <set>

namespace feldspar
{
namespace
{
std::string how_to_resume(const RunCommand& command, const std::filesystem::path& folder)
{
  return fmt::format("go on with: feldspar {} --resume {}", command.name, printable(folder.string()));
}

/// Prints which part of a run that came to its end has failed, if any has.
void tell_failure(const std::string& failure, const std::filesystem::path& folder)
{
  if (!failure.empty())
    fmt::print(stderr, "feldspar: {}; the other results are in {}\n", excerpt(failure, 1000),
               printable(folder.string()));
}

/// Continues from wherever the run stands.
int go_on(const RunCommand& command, const Run& run)
{
  const auto end_interrupted = [&] {
    if (ranks::is_first())
      fmt::print(stderr, "feldspar: interrupted; {}\n", how_to_resume(command, run.folder));
    return exit_code::interrupted;
  };
  const auto cannot_write = [&](const std::exception& error) {
    return OutputError(fmt::format("{}; once it can, {}", error.what(), how_to_resume(command, run.folder)));
  };
  try
    {
      const RunEnd end = command.go(run);
      if (end.was_interrupted)
        return end_interrupted();
      ranks::first([&] {
        remove_listed_files(run.folder, "checkpoints/");
        mark_complete(run.folder, end.failure, end.code_of_failure);
        tell_failure(end.failure, run.folder);
      });
      return end.failure.empty() ? 0 : end.code_of_failure;
    }
  catch (const Interrupted&)
    {
      return end_interrupted();
    }
  catch (const OutputError& error)
    {
      throw cannot_write(error);
    }
  catch (const std::filesystem::filesystem_error& error) // a folder that cannot be made, a file that cannot be moved
    {
      throw cannot_write(error);
    }
}

/// Reads the files of grains that an input names, so that a wrong one is refused before any file is removed. Throws
/// InputError.
void read_bodies(const Input& input)
{
  std::set<std::string> read;
  for (const Variant& variant : variants(input))
    {
      const SpecimenParameters& specimen = variant.input.specimen;
      const bool is_plane = specimen.dimension == 2;
      if (!specimen.specimen_file.empty() && read.insert(specimen.specimen_file).second)
        is_plane ? void(read_specimen<2>(specimen.specimen_file, end_if_interrupted))
                 : void(read_specimen<3>(specimen.specimen_file, end_if_interrupted));
      if (!specimen.packing_file.empty() && read.insert(specimen.packing_file).second)
        is_plane ? void(read_packing<2>(specimen, end_if_interrupted))
                 : void(read_packing<3>(specimen, end_if_interrupted));
    }
}

int resume(const RunCommand& command, const CommonOptions& options)
{
  std::optional<FolderLock> lock;
  ranks::first([&] { lock.emplace(*options.resume); });
  const RunRecord record = read_run_record(command.name, *options.resume);
  const FileList list(*options.resume);
  ranks::first([&] {
    forget_earlier_run(*options.resume);
    if (!record.remark.empty())
      fmt::print(stderr, "feldspar: {}\n", printable(record.remark));
  });
  if (record.complete)
    {
      if (ranks::is_first())
        {
          print_result("{}: this run is complete\n", options.resume->string());
          tell_failure(record.failure, *options.resume);
        }
      return record.failure.empty() ? 0 : record.code_of_failure;
    }
  command.check(record.input, record.input_file);
  return go_on(command, {*options.resume, record.input_file, record.input, options.quiet});
}

int begin(const RunCommand& command, const CommonOptions& options)
{
  const Input input = read_input(options.input, {}, options.settings);
  command.check(input, options.input);
  // The first process makes the folder and begins the record of the run; the others learn its name.
  std::optional<OutputFolder> made;
  std::optional<FolderLock> lock;
  std::optional<FileList> list;
  std::optional<EarlierRun> earlier;
  ranks::first([&] {
    made.emplace(options.output, options.input, write_over(options, places_of_runs, input));
    lock.emplace(made->path());
    earlier.emplace(made->path()); // with --force: what it left would be taken for this run's
    list.emplace(made->path());
    try
      {
        write_run_record(command.name, input, options.input, options.settings, made->path());
      }
    catch (const OutputError&)
      {
        remove_listed_files(made->path());
        earlier->restore();
        throw;
      }
  });
  const std::filesystem::path folder = ranks::of_first(made ? made->path().string() : "");
  if (!list)
    list.emplace(folder);
  try
    {
      return go_on(command, {folder, options.input, input, options.quiet});
    }
  catch (const InputError&)
    {
      list.reset(); // in all processes before the list of the earlier run comes back
      ranks::first([] {});
      ranks::first([&] { // a mistake leaves nothing, and takes nothing
        remove_listed_files(folder);
        earlier->restore();
      });
      throw;
    }
}

RunEnd go(const Run& run, const SharedRun& shared)
{
  Progress progress(run.quiet || !ranks::is_first());
  if (ranks::number() == 1)
    return shared.go_alone(run, progress);
  shared.share_out(run, progress);
  RunEnd end{};
  together_or_interrupted([&] {
    if (ranks::is_first())
      end = shared.go_alone(run, progress);
  });
  end.was_interrupted = ranks::any(end.was_interrupted);
  return end;
}
} // namespace

std::function<void(const std::filesystem::path&)> write_over(const CommonOptions& options, const Places& places,
                                                             const Input& input)
{
  if (!options.force)
    return {};
  std::vector<std::filesystem::path> inputs = named_files(input);
  inputs.insert(inputs.begin(), options.input);
  return [=, &places](const std::filesystem::path& folder) {
    check_write_over(folder, places, inputs);
    read_bodies(input);
  };
}

int run_command(const RunCommand& command, const CommonOptions& options)
{
  if (options.input.empty() && !options.resume)
    throw InputError("{0} needs an INPUT, or --resume with the folder of a run; see feldspar {0} --help", command.name);
  watch_for_interrupt(ranks::is_first() && !options.quiet);
  return options.resume ? resume(command, options) : begin(command, options);
}

int run_shared(const std::string& name,
               const std::function<void(const Input&, const std::filesystem::path& input_file)>& check,
               const SharedRun& plane, const SharedRun& space, const CommonOptions& options)
{
  const auto program = [&] {
    const auto by_dimension = [&](const Run& run) {
      return go(run, run.input.specimen.dimension == 2 ? plane : space);
    };
    return run_command({name, check, by_dimension}, options);
  };
  return is_launched() ? with_mpi(program) : program();
}
} // namespace feldspar

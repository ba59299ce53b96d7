#include "app/commands/commands.h"
#include "app/input/input.h"
#include "app/input/strain_path.h"
#include "app/run/checkpoints.h"
#include "app/run/interrupt.h"
#include "app/run/jobs.h"
#include "app/run/provenance.h"
#include "app/run/reference_body.h"
#include "app/run/run_record.h"
#include "app/run/rve_results.h"
#include "app/run/specimen_source.h"
#include "app/screen/print_result.h"
#include "app/screen/progress.h"
#include "base/input_error.h"
#include "base/whole_file.h"
#include "coupling/rve/explicit_run.h"
#include "coupling/rve/volume_file.h"

#include <Eigen/Geometry>
#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <mutex>

/// `feldspar rve`: representative volumes along a path of strain or stress, one for each seed.
namespace feldspar
{
namespace
{
using Clock = std::chrono::steady_clock;

double seconds_since(const Clock::time_point start)
{
  return std::chrono::duration<double>(Clock::now() - start).count();
}

/// Tells the progress how all volumes stand.
class Board
{
public:
  Board(Progress& shown, const std::size_t n_volumes)
    : progress(shown)
    , entries(n_volumes)
  {
    progress.start("paths");
  }

  void update(const std::size_t k, const double fraction, const std::string& text)
  {
    const std::lock_guard lock(showing);
    entries[k] = {fraction, text};
    double sum = 0.0;
    std::vector<ProgressDetail> running;
    for (const auto& entry : entries)
      {
        sum += entry.fraction / double(entries.size());
        if (entry.fraction > 0.0 && entry.fraction < 1.0)
          running.push_back(entry);
      }
    progress.update(sum, fmt::format("{} volume(s)", entries.size()), running);
  }

private:
  Progress& progress;
  std::mutex showing;
  std::vector<ProgressDetail> entries;
};

template <int dim>
std::string describe(const std::string& name, const PathSample<dim>& sample)
{
  std::string stresses;
  for (const double component : sample.stress)
    stresses += fmt::format("{}{:.2f}", stresses.empty() ? "" : ", ", component / 1e6);
  return fmt::format("{}: stress {} MPa, {} cracks", name, stresses, sample.n_tension_cracks + sample.n_shear_cracks);
}

/// Hears how far a path is and what its last sample was.
template <int dim>
using Listener = std::function<void(double progress, const PathSample<dim>& sample)>;

/// A path from its last checkpoint, if there is one, to its end or to Ctrl-C. `begin` makes the run at the start of its
/// path.
template <typename Begin, typename Show>
auto go_path(const Begin& begin, const Checkpoints& checkpoints, const Show& show)
{
  auto run = checkpoints.open(begin);
  CheckpointClock clock;
  while (!run.has_ended() && !interrupted())
    {
      run.advance();
      show(run.progress(), run.record().samples.back());
      if (clock.is_due())
        clock.time([&] { checkpoints.write(run); });
    }
  checkpoints.write(run);
  return run;
}

/// From x towards y, in space from z towards x.
template <int dim>
Tensor<dim> turn_of_cell(const double angle)
{
  if constexpr (dim == 2)
    return Eigen::Rotation2Dd(angle).toRotationMatrix();
  else
    return Eigen::AngleAxisd(angle, Vector<3>::UnitY()).toRotationMatrix();
}

/// The path of one volume by the solver that is wanted.
template <int dim>
FinishedVolume<dim> run_volume(const Variant& variant, const std::string& name, const Specimen<dim>& specimen,
                               const std::filesystem::path& folder, const Listener<dim>& show)
{
  const auto started = Clock::now();
  const Input& input = variant.input;
  // Shared: the run and its result refer to it.
  const auto network = std::make_shared<const Network<dim>>(specimen, turn_of_cell<dim>(input.strain_path.cell_angle));
  const auto legs = path_legs<dim>(input.strain_path);
  const Checkpoints checkpoints(folder / "checkpoints", name, run_identity(input, name));
  const auto finish = [&](const auto& run) -> FinishedVolume<dim> {
    return {name,    variant.label, specimen.seed, specimen.report,
            network, run.record(),  run.state(),   seconds_since(started)};
  };
  std::optional<NetworkState<dim>> start; // a volume out of a sample goes on from where it stands there
  if (const std::string& file = input.specimen.specimen_file; !file.empty())
    start = read_volume_state(file, *network);
  if (start && input.strain_path.cell_angle != 0.0)
    throw InputError(fmt::format("Strain path/Cell angle: {} is a volume in the state it has in its sample, which is "
                                 "in the axes of its cell; set Cell angle = 0 deg",
                                 input.specimen.specimen_file));
  if (start && !input.flaws.all().empty())
    throw InputError(
      fmt::format("Flaws: {} is a volume in the state it has in its sample, and takes none; put them into "
                  "the volume of the sample",
                  input.specimen.specimen_file));
  if (start && input.strain_path.solver == PathSolver::explicit_dynamics)
    throw InputError(fmt::format("Strain path/Solver = explicit: {} is a volume in the state it has in its sample, and "
                                 "explicit dynamics begin at rest; set Solver = event by event",
                                 input.specimen.specimen_file));
  if (input.strain_path.solver == PathSolver::explicit_dynamics)
    return finish(go_path(
      [&] {
        return ExplicitRun<dim>(specimen, network, legs,
                                {.largest_step = input.strain_path.largest_step,
                                 .steps_per_millistrain = input.strain_path.steps_per_millistrain,
                                 .dynamics = input.dynamics});
      },
      checkpoints, show));
  return finish(go_path(
    [&] {
      return PathRun<dim>(network, legs,
                          {.largest_step = input.strain_path.largest_step, .equilibrium = input.equilibrium}, start);
    },
    checkpoints, show));
}

template <int dim>
RunEnd go(const Run& run)
{
  const auto& [folder, input_file, input, quiet] = run;
  Progress progress(quiet);

  // Make the rock.
  const auto all_variants = variants(input);
  const auto orders = specimen_orders(all_variants);
  const auto specimens = provide_specimens<dim>(all_variants, orders, folder, progress);
  for (const auto& specimen : specimens)
    if (!specimen.periodic)
      throw InputError(fmt::format("{}: Specimen/Specimen file: is a specimen between walls; a representative volume "
                                   "needs a periodic cell (feldspar lab takes walls)",
                                   input_file.string()));

  // Strain it.
  std::filesystem::create_directories(folder / "checkpoints");
  struct PlannedPath
  {
    std::size_t variant;
    std::size_t specimen;
    std::string name;
  };
  std::vector<PlannedPath> runs;
  for (std::size_t v = 0; v < all_variants.size(); ++v)
    for (std::size_t s = 0; s < orders.size(); ++s)
      if (std::count(orders[s].variants.begin(), orders[s].variants.end(), v) > 0)
        runs.push_back({v, s,
                        "rve" + (all_variants.size() > 1 ? fmt::format("_variant_{}", v + 1) : std::string()) +
                          (input.seeds.size() > 1 ? fmt::format("_seed_{}", orders[s].seed) : std::string())});
  std::vector<FinishedVolume<dim>> volumes(runs.size());
  Board board(progress, runs.size());
  for_each_job(runs.size(), [&](const std::size_t k) {
    const auto& [variant, specimen, name] = runs[k];
    volumes[k] = run_volume<dim>(all_variants[variant], name, specimens[specimen], folder,
                                 [&](const double progress_of_path, const PathSample<dim>& sample) {
                                   board.update(k, progress_of_path, describe(name, sample));
                                 });
  });
  progress.finish(fmt::format("{} volume(s)", volumes.size()));

  // Report.
  const bool was_interrupted = interrupted();
  write_results(provenance(input, input_file), volumes, folder);
  std::string text;
  for (const auto& volume : volumes)
    text += describe(volume) + "\n";
  std::vector<SpecimenReport> bodies;
  for (const auto& specimen : specimens)
    bodies.push_back(specimen.report);
  for (const std::string& line : beside_reference_body(input, bodies))
    text += line + "\n";
  write_whole_file(folder / "log.txt", text);
  if (!quiet)
    print_result("\n{}", text);
  print_result("{}\n", folder.string());
  const auto failed = std::find_if(volumes.begin(), volumes.end(),
                                   [](const FinishedVolume<dim>& volume) { return !volume.record.failure.empty(); });
  return {was_interrupted, failed == volumes.end() ? "" : fmt::format("{}: {}", failed->name, failed->record.failure)};
}

/// What can be told before any work.
void check(const Input& input, const std::filesystem::path& file)
{
  try
    {
      for (const Variant& variant : variants(input))
        {
          if (variant.input.specimen.shape != "periodic" && variant.input.specimen.specimen_file.empty())
            throw InputError(fmt::format("Specimen/Shape = {}: a representative volume needs Shape = periodic",
                                         variant.input.specimen.shape));
          check(variant.input.strain_path);
        }
      reference_body(input);
    }
  catch (const InputError& error)
    {
      throw InputError(fmt::format("{}: {}", file.string(), error.what()));
    }
  for (const Variant& variant : variants(input))
    if (variant.input.specimen.dimension == 2)
      path_legs<2>(variant.input.strain_path);
    else
      path_legs<3>(variant.input.strain_path);
}
} // namespace

int run_rve(const CommonOptions& options)
{
  const RunCommand rve{"rve", [](const Input& input, const std::filesystem::path& file) { check(input, file); },
                       [](const Run& run) { return run.input.specimen.dimension == 2 ? go<2>(run) : go<3>(run); }};
  return run_command(rve, options);
}
} // namespace feldspar

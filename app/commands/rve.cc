#include "app/commands/commands.h"
#include "app/input/input.h"
#include "app/input/strain_path.h"
#include "app/programme/checks.h"
#include "app/programme/reference_body.h"
#include "app/programme/run_report.h"
#include "app/programme/rve_results.h"
#include "app/programme/specimen_source.h"
#include "app/run/checkpoints.h"
#include "app/run/interrupt.h"
#include "app/run/jobs.h"
#include "app/run/launched.h"
#include "app/run/provenance.h"
#include "app/run/run_record.h"
#include "app/screen/progress.h"
#include "base/input_error.h"
#include "base/parallel.h"
#include "base/ranks/ranks.h"
#include "coupling/rve/explicit_run.h"
#include "coupling/rve/rve_file.h"
#include "dem/specimen/specimen_file.h"

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

/// Tells the progress how all RVEs stand.
class Board
{
public:
  Board(Progress& shown, const std::size_t n_rves)
    : progress(shown)
    , entries(n_rves)
  {
    progress.start("paths");
  }

  void update(const std::size_t k, const double fraction, const std::string& name, const std::string& text)
  {
    const std::lock_guard lock(showing);
    entries[k] = {fraction, name, text};
    double sum = 0.0;
    std::vector<ProgressDetail> running;
    for (const auto& entry : entries)
      {
        sum += entry.fraction / double(entries.size());
        if (entry.fraction > 0.0 && entry.fraction < 1.0)
          running.push_back(entry);
      }
    progress.update(sum, fmt::format("{} RVE(s)", entries.size()), running);
  }

private:
  Progress& progress;
  std::mutex showing;
  std::vector<ProgressDetail> entries;
};

template <int dim>
std::string describe(const PathSample<dim>& sample)
{
  std::string stresses;
  for (const double component : sample.stress)
    stresses += fmt::format("{}{:.2f}", stresses.empty() ? "" : ", ", component / 1e6);
  return fmt::format("stress {} MPa, {} cracks", stresses, sample.n_tension_cracks + sample.n_shear_cracks);
}

/// Hears how far a path is and what its last sample was.
template <int dim>
using Listener = std::function<void(double progress, const PathSample<dim>& sample)>;

/// Advances a run. A resumed run repeats the step that was interrupted.
template <int dim>
void advance(PathRun<dim>& run)
{
  try
    {
      run.advance(interrupted);
    }
  catch (const GivenUp&)
    {
    }
}

template <int dim>
void advance(ExplicitRun<dim>& run)
{
  run.advance();
}

/// A path from its last checkpoint, if there is one, to its end or to Ctrl-C. `begin` makes the run at the start of its
/// path.
template <typename Begin, typename Show>
auto go_path(const Begin& begin, const Checkpoints& checkpoints, const Show& show)
{
  auto run = checkpoints.open(begin);
  CheckpointClock clock;
  while (!run.has_ended() && !interrupted())
    {
      advance(run);
      show(run.progress(), run.record().samples.back());
      if (clock.is_due())
        clock.time([&] { checkpoints.write(run); });
    }
  checkpoints.write(run);
  return run;
}

/// Rotation of the cell from x towards y, in space from z towards x.
template <int dim>
Tensor<dim> turn_of_cell(const double angle)
{
  if constexpr (dim == 2)
    return Eigen::Rotation2Dd(angle).toRotationMatrix();
  else
    return Eigen::AngleAxisd(angle, Vector<3>::UnitY()).toRotationMatrix();
}

/// The path of one RVE by the solver that is wanted.
template <int dim>
FinishedRve<dim> run_rve(const Variant& variant, const std::string& name, const Specimen<dim>& specimen,
                         const std::filesystem::path& folder, const Listener<dim>& show)
{
  const auto started = Clock::now();
  const Input& input = variant.input;
  // Shared: the run and its result refer to it.
  const Tensor<dim> turn = turn_of_cell<dim>(input.strain_path.cell_angle);
  const auto network = std::make_shared<const Network<dim>>(specimen, turn, input.boundary);
  const auto legs = path_legs<dim>(input.strain_path);
  const Checkpoints checkpoints(folder / "checkpoints", name, run_identity(input, name));
  const auto bounds = stiffness_bounds(specimen, turn);
  const auto finish = [&](const auto& run) -> FinishedRve<dim> {
    return {name,    variant.label, variant.settings, specimen.seed, specimen.report,
            network, bounds,        run.record(),     run.state(),   seconds_since(started)};
  };
  std::optional<NetworkState<dim>> start; // an RVE out of a sample goes on from where it stands there
  if (const std::string& file = input.specimen.specimen_file; !file.empty())
    start = read_rve_state(file, *network);
  if (start)
    check_rve_out_of_sample(input);
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

struct PlannedPath
{
  std::size_t variant;
  std::size_t specimen;
  std::string name;
};

std::vector<PlannedPath> plan(const Input& input, const std::vector<Variant>& all_variants,
                              const std::vector<SpecimenOrder>& orders)
{
  std::vector<PlannedPath> runs;
  const auto part = [](const std::string& name) { return name.empty() ? name : '_' + name; };
  for (std::size_t v = 0; v < all_variants.size(); ++v)
    for (std::size_t s = 0; s < orders.size(); ++s)
      if (std::count(orders[s].variants.begin(), orders[s].variants.end(), v) > 0)
        runs.push_back({v, s,
                        "rve" + part(all_variants[v].name_in_files) +
                          (input.seeds.size() > 1 ? fmt::format("_seed_{}", orders[s].seed) : std::string())});
  return runs;
}

/// Several processes make cells and paths, each those whose turn it is: what has ended lies in the folder.
template <int dim>
void share_out_paths(const Run& run, Progress& progress)
{
  const auto all_variants = variants(run.input);
  const auto orders = specimen_orders(all_variants);
  const auto paths = plan(run.input, all_variants, orders);
  const auto in_turn = [](const std::size_t k) { return k % ranks::number() == ranks::mine(); };
  together_or_interrupted([&] {
    std::vector<SpecimenOrder> own;
    for (std::size_t s = 0; s < orders.size(); ++s)
      if (in_turn(s))
        own.push_back(orders[s]);
    if (!own.empty())
      provide_specimens<dim>(all_variants, own, run.folder, progress);
  });
  ranks::first([&] { std::filesystem::create_directories(run.folder / "checkpoints"); });
  together_or_interrupted([&] {
    std::vector<PlannedPath> own;
    for (std::size_t k = 0; k < paths.size(); ++k)
      if (in_turn(k))
        own.push_back(paths[k]);
    Board board(progress, std::max<std::size_t>(own.size(), 1));
    for_each_job(own.size(), [&](const std::size_t k) {
      const PlannedPath& path = own[k];
      const auto cell = read_specimen<dim>(run.folder / (orders[path.specimen].name + ".h5"));
      if (cell.is_periodic())
        run_rve<dim>(all_variants[path.variant], path.name, cell, run.folder,
                     [&](const double progress_of_path, const PathSample<dim>& sample) {
                       board.update(k, progress_of_path, path.name, describe(sample));
                     });
    });
    progress.finish(fmt::format("{} of {} RVE(s)", own.size(), paths.size()));
    end_if_interrupted();
  });
}

template <int dim>
RunEnd strain_alone(const Run& run, Progress& progress)
{
  const Input& input = run.input;

  // Make the rock.
  const auto all_variants = variants(input);
  const auto orders = specimen_orders(all_variants);
  const auto specimens = provide_specimens<dim>(all_variants, orders, run.folder, progress);
  with_name_of(run.input_file, [&] {
    for (const auto& specimen : specimens)
      check_cell(specimen, "a representative volume");
  });

  // Strain it.
  std::filesystem::create_directories(run.folder / "checkpoints");
  const auto runs = plan(input, all_variants, orders);
  std::vector<FinishedRve<dim>> rves(runs.size());
  Board board(progress, runs.size());
  for_each_job(runs.size(), [&](const std::size_t k) {
    const PlannedPath& path = runs[k];
    rves[k] = run_rve<dim>(all_variants[path.variant], path.name, specimens[path.specimen], run.folder,
                           [&](const double progress_of_path, const PathSample<dim>& sample) {
                             board.update(k, progress_of_path, path.name, describe(sample));
                           });
  });
  progress.finish(fmt::format("{} RVE(s)", rves.size()));

  // Report.
  const bool was_interrupted = interrupted();
  write_results(provenance(input, run.input_file), rves, run.folder);
  std::string text;
  for (const auto& rve : rves)
    text += describe(rve) + "\n";
  std::vector<SpecimenReport> bodies;
  for (const auto& specimen : specimens)
    bodies.push_back(specimen.report);
  for (const std::string& line : beside_reference_body(input, bodies))
    text += line + "\n";
  write_log(run.folder, text, run.quiet);
  const auto failed =
    std::find_if(rves.begin(), rves.end(), [](const FinishedRve<dim>& rve) { return !rve.record.failure.empty(); });
  return {was_interrupted, failed == rves.end() ? "" : fmt::format("{}: {}", failed->name, failed->record.failure)};
}

} // namespace

int run_rve(const CommonOptions& options)
{
  return run_shared("rve", check_rve_input, {share_out_paths<2>, strain_alone<2>},
                    {share_out_paths<3>, strain_alone<3>}, options);
}
} // namespace feldspar

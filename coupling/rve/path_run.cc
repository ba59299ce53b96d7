#include "coupling/rve/path_run.h"

#include "base/parallel.h"
#include "base/parameter_id.h"
#include "base/system/hdf5_archive.h"
#include "coupling/rve/rve_file.h"
#include "coupling/rve/state_archive.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace feldspar
{
template <int dim>
std::string describe(const Control<dim>& control)
{
  std::string text;
  for (int k = 0; k < n_voigt<dim>; ++k)
    {
      const std::string given =
        control.stress_given[k]
          ? fmt::format("stress_{} = {:.6g} MPa", voigt_name<dim>(k), control.stress[k] / 1e6)
          : fmt::format("strain_{} = {:.6g}", voigt_name<dim>(k), control.strain[k] / engineering_factor<dim>(k));
      text += (text.empty() ? "" : ", ") + given;
    }
  return text;
}

template <int dim>
LegCourse<dim>::LegCourse(const PathLeg<dim>& leg, const NetworkState<dim>& from, const RepresentativeVolume<dim>& rve)
  : start(leg.target)
  , target(leg.target)
{
  start.strain = from.strain;
  start.stress = from.stress;
  if (leg.counts_from_here)
    target.strain += from.strain;
  way = rve.intact_strain(target) - rve.intact_strain(start);
}

template <int dim>
Control<dim> LegCourse<dim>::at(const double share) const
{
  Control<dim> control = target;
  control.strain = start.strain + share * (target.strain - start.strain);
  control.stress = start.stress + share * (target.stress - start.stress);
  return control;
}

template <int dim>
std::uint64_t LegCourse<dim>::n_increments(const double largest_step) const
{
  // A leg without a way is one increment: it finds the equilibrium.
  return std::uint64_t(std::max(1.0, std::ceil(size() / largest_step - 1e-9)));
}

template <int dim>
double PathSample<dim>::turnover() const
{
  return std::abs(work.boundary) + std::abs(stored_energy) + std::abs(work.slip) + std::abs(work.released) +
         std::abs(work.settled);
}

template <int dim>
double PathSample<dim>::energy_imbalance() const
{
  const double size = turnover();
  return size > 0.0 ? std::abs(unaccounted()) / size : 0.0;
}

void write_path_checkpoint(const std::filesystem::path& file, const std::string& identity,
                           const std::function<void(Hdf5Writer&)>& transfer)
{
  write_hdf5(file, [&](Hdf5Writer& root) {
    std::string of_run = identity;
    root.text("identity", of_run);
    transfer(root);
  });
}

void read_path_checkpoint(const std::filesystem::path& file, const std::string& identity,
                          const std::function<void(Hdf5Reader&)>& transfer)
{
  read_hdf5(file, "a checkpoint of " + in_words(Work::strain_path), [&](Hdf5Reader& root) {
    std::string of_run;
    root.text("identity", of_run);
    if (of_run != identity)
      throw InputError("of another input or program");
    transfer(root);
  });
}
template <int dim>
PathRun<dim>::PathRun(std::shared_ptr<const Network<dim>> network, std::vector<PathLeg<dim>> wanted_legs,
                      const PathParameters& wanted, const std::optional<NetworkState<dim>>& begin)
  : legs(std::move(wanted_legs))
  , parameters(wanted)
  , body(std::move(network), wanted.equilibrium)
{
  if (begin)
    {
      body.restore(*begin);
      forces = borne_forces(body.network(), Equilibrium<dim>(body.network(), *begin, parameters.equilibrium));
      add(evaluate(*begin, *begin, 0.0));
    }
  else
    {
      forces.of_links.values.assign(body.network().links().size(), Motion<dim>::Zero());
      path_record.samples.emplace_back();
    }
  begin_leg();
}

template <int dim>
void PathRun<dim>::begin_leg()
{
  start = body.state();
  position = 0;
  cuts = 0;
  if (leg == legs.size())
    return;
  course = LegCourse<dim>(legs[leg], start, body);
  length = course.n_increments(parameters.largest_step) << parameters.most_cuts;
}

template <int dim>
void PathRun<dim>::advance(const std::function<bool()>& gives_up)
{
  // State that an increment changes before its last search.
  const NetworkState<dim> state = body.state();
  const PathSample<dim> row = path_record.samples.back();
  const BorneForces<dim> forces_before = forces;
  const bool was_short = next_is_short;
  try
    {
      go_an_increment(gives_up);
    }
  catch (const GivenUp&)
    {
      body.restore(state);
      path_record.samples.back() = row;
      forces = forces_before;
      next_is_short = was_short;
      throw;
    }
}

template <int dim>
void PathRun<dim>::go_an_increment(const std::function<bool()>& gives_up)
{
  const auto options = [&](const Bonds bonds, const double share_of_tolerance = 1.0) {
    return TrialOptions<dim>{.bonds = bonds, .share_of_tolerance = share_of_tolerance, .gives_up = gives_up};
  };
  // An increment goes to the next mark of its own kind, also from where a break was found between two.
  const std::uint64_t longest = std::uint64_t(1) << (parameters.most_cuts - cuts);
  std::uint64_t increment = next_is_short ? 1 : longest - position % longest;
  next_is_short = false;
  Trial<dim> trial =
    body.trial(control_at(position + increment), options(increment > 1 ? Bonds::until_break : Bonds::may_break));
  if (trial.would_break)
    {
      // The increment ends before the break; the break itself then lies within one of the smallest cuts.
      const auto until_break = std::uint64_t(std::ceil(trial.share_until_break * double(increment)));
      increment = std::clamp(until_break > 1 ? until_break - 1 : 1, std::uint64_t(1), increment - 1);
      trial = body.trial(control_at(position + increment), options(Bonds::may_break));
      next_is_short = trial.n_loosened == 0;
    }
  if (!trial.in_equilibrium)
    {
      if (cuts == parameters.most_cuts)
        {
          const bool has_strained_far = trial.state.strain.cwiseAbs().maxCoeff() > largest_strain;
          const std::string end =
            has_strained_far ? fmt::format(": in the search the cell strained by more than {:g}", largest_strain) : "";
          path_record.failure = fmt::format("no equilibrium was found at {}{}; the path ends before it, at {}",
                                            describe(control_at(position + increment)), end,
                                            describe(strain_control<dim>(body.state().strain)));
        }
      else
        ++cuts;
      return;
    }
  auto evaluated = evaluate(trial.state, body.state(), trial.unbalanced_ratio);
  // A residual that is small beside the contact forces need not be small beside the work of an increment in which a
  // crack ran through the RVE. The increment is then repeated from a more exact beginning, which takes the place of the
  // last row, to a more exact end.
  double share_of_tolerance = 1.0;
  for (int k = 0; k < 3 && evaluated.sample.hill_mandel_residual > 10.0 * parameters.equilibrium.final_tolerance; ++k)
    {
      share_of_tolerance *= 0.1;
      const auto exacter = options(Bonds::may_break, share_of_tolerance);
      auto beginning = body.trial(control_at(position), exacter);
      if (!beginning.in_equilibrium || beginning.n_loosened > 0)
        break;
      auto& row = path_record.samples.back();
      // The correction of the row does hardly any work of its own: it is a part of the increment that led there.
      const std::size_t n_rows = path_record.samples.size();
      const double work_of_row = n_rows > 1 ? row.work.boundary - path_record.samples[n_rows - 2].work.boundary : 0.0;
      auto last = evaluate(beginning.state, body.state(), beginning.unbalanced_ratio, std::abs(work_of_row));
      last.sample.hill_mandel_residual = std::max(row.hill_mandel_residual, last.sample.hill_mandel_residual);
      row = last.sample;
      forces = std::move(last.forces);
      body.accept(std::move(beginning));
      auto again = body.trial(control_at(position + increment), exacter);
      if (!again.in_equilibrium)
        break;
      trial = std::move(again);
      evaluated = evaluate(trial.state, body.state(), trial.unbalanced_ratio);
    }
  if (!is_finite(evaluated.sample))
    {
      path_record.failure =
        fmt::format("numbers went wrong at {}; the path ends before it, at {}",
                    describe(control_at(position + increment)), describe(strain_control<dim>(body.state().strain)));
      return;
    }
  for (const auto& event : trial.breaks)
    {
      const std::uint32_t joint = body.network().link_of_segment(event.segment);
      path_record.cracks.push_back({path_record.samples.size(), joint,
                                    event.segment - body.network().links()[joint].first_segment, event.in_tension,
                                    event.released_energy});
    }
  body.accept(std::move(trial));
  add(std::move(evaluated));

  position += increment;
  if (cuts > 0 && position % (2 * longest) == 0)
    --cuts;
  if (position == length)
    {
      ++leg;
      begin_leg();
    }
}

/// A state that follows the one before, whose link forces are `forces`; its Hill-Mandel residual is a share of at least
/// `least_work` [J].
template <int dim>
typename PathRun<dim>::Evaluation PathRun<dim>::evaluate(const NetworkState<dim>& state,
                                                         const NetworkState<dim>& before, const double unbalanced_ratio,
                                                         const double least_work) const
{
  const Equilibrium<dim> equilibrium(body.network(), state, parameters.equilibrium);
  Evaluation evaluated;
  evaluated.forces = borne_forces(body.network(), equilibrium);
  auto& sample = evaluated.sample;
  std::copy(state.strain.begin(), state.strain.end(), sample.strain.begin());
  std::copy(state.stress.begin(), state.stress.end(), sample.stress.begin());
  sample.n_tension_cracks = state.n_tension_breaks;
  sample.n_shear_cracks = state.n_shear_breaks;
  sample.work = state.work;
  sample.stored_energy = equilibrium.stored_energy();
  sample.unbalanced_ratio = unbalanced_ratio;
  // An RVE that has come apart does no work but round-off.
  constexpr double least_share_of_work = 1e-6;
  sample.hill_mandel_residual =
    hill_mandel_residual(body.network(), before, forces, state, evaluated.forces,
                         std::max(least_work, least_share_of_work * std::abs(state.work.boundary)));
  const Tensor<dim> stress = branch_stress(body.network(), evaluated.forces.of_links);
  if (const double size = stress.norm(); size > 0.0)
    sample.boundary_stress_error =
      (boundary_stress(body.network(), equilibrium.conditions(), evaluated.forces.of_links) - stress).norm() / size;
  sample.crack_density = crack_measures(body.network(), state).density;
  return evaluated;
}

template <int dim>
void PathRun<dim>::add(Evaluation&& evaluated)
{
  path_record.samples.push_back(evaluated.sample);
  forces = std::move(evaluated.forces);
}

template <int dim>
double PathRun<dim>::progress() const
{
  return (double(leg) + double(position) / double(length)) / double(legs.size());
}

template <int dim>
template <typename Archive>
void PathRun<dim>::transfer(Archive& archive)
{
  auto state_group = archive.subgroup("state");
  NetworkState<dim> state = body.state();
  feldspar::transfer(state_group, state);
  archive.value("leg", leg);
  if (leg > legs.size())
    throw InputError("a path of another length");
  auto start_group = archive.subgroup("start");
  feldspar::transfer(start_group, start);
  if constexpr (Archive::reads)
    {
      if (!fits(state, body.network()) || !fits(start, body.network()))
        throw InputError("a state of another specimen");
      body.restore(start);
      begin_leg(); // the target and the length of the leg
      body.restore(state);
    }
  archive.value("position", position);
  archive.value("cuts", cuts);
  transfer_flag(archive, "next_is_short", next_is_short);
  archive.array("samples", path_record.samples);
  archive.array("cracks", path_record.cracks);
  archive.text("failure", path_record.failure);
  if constexpr (Archive::reads)
    forces = borne_forces(body.network(), Equilibrium<dim>(body.network(), state, parameters.equilibrium));
}

template <int dim>
void PathRun<dim>::write_checkpoint(const std::filesystem::path& file, const std::string& identity) const
{
  write_path_checkpoint(file, identity, [&](Hdf5Writer& root) {
    PathRun copy = *this; // one description serves writing and reading, and reading changes
    copy.transfer(root);
  });
}

template <int dim>
void PathRun<dim>::read_checkpoint(const std::filesystem::path& file, const std::string& identity)
{
  read_path_checkpoint(file, identity, [&](Hdf5Reader& root) { transfer(root); });
}

template struct LegCourse<2>;
template struct LegCourse<3>;
template std::string describe(const Control<3>&);
template std::string describe(const Control<2>&);
template struct PathSample<2>;
template class PathRun<2>;
template struct PathSample<3>;
template class PathRun<3>;
} // namespace feldspar

#include "coupling/rve/explicit_run.h"

#include "base/contains.h"
#include "base/system/hdf5_archive.h"
#include "coupling/rve/homogenisation.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace feldspar
{
namespace
{
// The servo of given stresses. The error falls by 1/e in 50 steps, some transits of a wave between neighbours; the gain of
// what it learns is the one without overshoot. Both are shares of the intact RVE's response.
constexpr double gain = 0.02;
constexpr double learning_gain = 0.25 * gain * gain;
constexpr double largest_correction = 1e-5; // strain per step: some 0.7 MPa in granite
// A stress counts as beyond what the RVE holds where so much of it, over the largest stress there was, has been missing
// for so long or is when a leg ends.
constexpr double largest_missing_share = 0.05;
constexpr std::uint64_t most_steps_missing = 1000;

template <int dim, typename Archive>
void transfer(Archive& archive, const std::string& name, Voigt<dim>& voigt)
{
  for (int k = 0; k < n_voigt<dim>; ++k)
    archive.value(name + "_" + voigt_name<dim>(k), voigt[k]);
}
} // namespace

template <int dim>
ExplicitRun<dim>::ExplicitRun(const Specimen<dim>& specimen, std::shared_ptr<const Network<dim>> network,
                              std::vector<PathLeg<dim>> wanted_legs, const ExplicitParameters& wanted)
  : legs(std::move(wanted_legs))
  , parameters(wanted)
  , intact(std::move(network))
  , dynamics(specimen, wanted.dynamics, ZeroForce::as_placed)
{
  const auto& numbers = specimen.joints.number;
  joint_of_number.resize(numbers.size());
  for (std::size_t j = 0; j < numbers.size(); ++j)
    joint_of_number[numbers[j]] = std::uint32_t(j);
  dynamics.step(); // at rest: finds the time step
  path_record.samples.emplace_back();
  begin_leg();
}

template <int dim>
void ExplicitRun<dim>::begin_leg()
{
  increment = 0;
  if (leg < legs.size())
    course = LegCourse<dim>(legs[leg], state(), intact);
}

template <int dim>
NetworkState<dim> ExplicitRun<dim>::state() const
{
  const PathSample<dim>& sample = path_record.samples.back();
  NetworkState<dim> result = intact.state();
  result.strain = strain;
  std::ranges::copy(sample.stress, result.stress.data());
  for (const auto& crack : path_record.cracks)
    result.unbonded.push_back({intact.network().links()[crack.joint].first_segment + crack.segment, {}});
  std::ranges::sort(result.unbonded, {}, &UnbondedSegment<dim>::segment);
  result.intact = result.unbonded.empty();
  result.n_tension_breaks = std::uint32_t(sample.n_tension_cracks);
  result.n_shear_breaks = std::uint32_t(sample.n_shear_cracks);
  result.work = sample.work;
  return result;
}

template <int dim>
void ExplicitRun<dim>::advance()
{
  try
    {
      go_an_increment();
    }
  catch (const Runaway& error)
    {
      // Breaks since the last sample may come from wrong numbers.
      const PathSample<dim>& last = path_record.samples.back();
      path_record.cracks.resize(last.n_tension_cracks + last.n_shear_cracks);
      path_record.failure = error.what();
    }
}

template <int dim>
void ExplicitRun<dim>::go_an_increment()
{
  const std::uint64_t n_increments = course.n_increments(parameters.largest_step);
  const double n_wanted = course.size() / double(n_increments) * 1e3 * double(parameters.steps_per_millistrain);
  const auto n_steps = std::uint64_t(std::max(1.0, std::ceil(n_wanted - 1e-9)));
  const auto control_at = [&](const std::uint64_t step) {
    return course.at((double(increment) + double(step) / double(n_steps)) / double(n_increments));
  };
  const Control<dim> end = control_at(n_steps);
  Voigt<dim> way = course.way / double(n_increments * n_steps);
  for (int k = 0; k < n_voigt<dim>; ++k)
    if (!end.stress_given[k])
      way[k] = (end.strain[k] - strain[k]) / double(n_steps);
  const bool served_stress = contains(end.stress_given, true);
  for (std::uint64_t s = 1; s <= n_steps; ++s)
    step(served_stress ? served(control_at(s), way) : way);
  ++increment;
  dynamics.check_motion();
  add_sample();
  if (served_stress)
    judge_servo(end);
  if (increment == n_increments)
    {
      ++leg;
      begin_leg();
    }
}

/// The strain of the next step: `way`, and what brings given stresses nearer.
template <int dim>
Voigt<dim> ExplicitRun<dim>::served(const Control<dim>& control, const Voigt<dim>& way)
{
  Control<dim> missing = control;
  missing.strain.setZero();
  const Voigt<dim> stress = stress_voigt<dim>(dynamics.mean_stress());
  missing.stress = control.stress - stress;
  for (int k = 0; k < n_voigt<dim>; ++k)
    missing.stress[k] *= control.stress_given[k];
  largest_stress = std::max({largest_stress, stress.norm(), control.stress.norm()});
  missing_stress = missing.stress.cwiseAbs().maxCoeff();
  n_steps_missing = missing_stress > largest_missing_share * largest_stress ? n_steps_missing + 1 : 0;
  const auto limited = [](const Voigt<dim>& of) -> Voigt<dim> {
    return of.cwiseMax(-largest_correction).cwiseMin(largest_correction);
  };
  const Voigt<dim> error = intact.intact_strain(missing);
  lag = limited(lag + learning_gain * error);
  return way + limited(gain * error + lag);
}

template <int dim>
void ExplicitRun<dim>::step(const Voigt<dim>& way)
{
  const Voigt<dim> rate = way / dynamics.time_step();
  dynamics.deform_body(strain_tensor<dim>(rate));
  for (const Break& event : dynamics.step())
    path_record.cracks.push_back({path_record.samples.size(),
                                  joint_of_number[dynamics.specimen().joints.number[event.joint]], event.segment,
                                  event.in_tension, event.released_energy});
  strain += rate * dynamics.time_step(); // which the step may have changed
}

template <int dim>
void ExplicitRun<dim>::judge_servo(const Control<dim>& control)
{
  const bool leg_ends = increment == course.n_increments(parameters.largest_step);
  if (n_steps_missing >= (leg_ends ? 1 : most_steps_missing))
    path_record.failure = fmt::format("the given stress could not be held at {}; the path ends there, with {:.6g} MPa "
                                      "missing",
                                      describe(control), missing_stress / 1e6);
}

template <int dim>
void ExplicitRun<dim>::add_sample()
{
  const Energies energies = dynamics.energies();
  const Tensor<dim> stress = dynamics.mean_stress();
  const PathSample<dim>& before = path_record.samples.back();
  PathSample<dim> sample = before;
  std::copy(strain.begin(), strain.end(), sample.strain.begin());
  const Voigt<dim> symmetric = stress_voigt<dim>(stress);
  std::copy(symmetric.begin(), symmetric.end(), sample.stress.begin());
  const auto& cracks = path_record.cracks;
  for (std::size_t k = before.n_tension_cracks + before.n_shear_cracks; k < cracks.size(); ++k)
    ++(cracks[k].in_tension ? sample.n_tension_cracks : sample.n_shear_cracks);
  sample.work = {energies.boundary_work, energies.slip, energies.released,
                 energies.damping + energies.kinetic - energies.kinetic_at_start};
  sample.stored_energy = energies.strain;
  sample.unbalanced_ratio = dynamics.largest_unbalanced_force_ratio();
  const double of_contacts = energies.strain + energies.slip + energies.released - work_of_contacts;
  const double of_body = sample.work.boundary - before.work.boundary;
  if (const double size = std::abs(of_contacts) + std::abs(of_body); size > 0.0)
    sample.hill_mandel_residual = std::abs(of_body - of_contacts) / size;
  if (const double size = stress.norm(); size > 0.0)
    sample.boundary_stress_error = (dynamics.boundary_stress() - stress).norm() / size;
  if (!is_finite(sample))
    throw dynamics.runaway("a stress or an energy of the cell is not finite");
  work_of_contacts += of_contacts;
  path_record.samples.push_back(sample);
  path_record.samples.back().crack_density = crack_measures(intact.network(), state()).density;
}

template <int dim>
double ExplicitRun<dim>::progress() const
{
  const double on_leg =
    leg < legs.size() ? double(increment) / double(course.n_increments(parameters.largest_step)) : 0;
  return (double(leg) + on_leg) / double(legs.size());
}

template <int dim>
template <typename Archive>
void ExplicitRun<dim>::transfer(Archive& archive)
{
  auto of_dynamics = archive.subgroup("dynamics");
  dynamics.transfer(of_dynamics);
  archive.value("leg", leg);
  if (leg > legs.size())
    throw InputError("a path of another length");
  NetworkState<dim> start;
  start.strain = course.start.strain;
  start.stress = course.start.stress;
  feldspar::transfer<dim>(archive, "start_strain", start.strain);
  feldspar::transfer<dim>(archive, "start_stress", start.stress);
  if constexpr (Archive::reads)
    if (leg < legs.size())
      course = LegCourse<dim>(legs[leg], start, intact);
  archive.value("increment", increment);
  feldspar::transfer<dim>(archive, "strain", strain);
  feldspar::transfer<dim>(archive, "lag", lag);
  archive.value("largest_stress", largest_stress);
  archive.value("missing_stress", missing_stress);
  archive.value("n_steps_missing", n_steps_missing);
  archive.value("work_of_contacts", work_of_contacts);
  archive.array("samples", path_record.samples);
  archive.array("cracks", path_record.cracks);
  archive.text("failure", path_record.failure);
}

template <int dim>
void ExplicitRun<dim>::write_checkpoint(const std::filesystem::path& file, const std::string& identity) const
{
  write_path_checkpoint(file, identity, [&](Hdf5Writer& root) {
    ExplicitRun copy = *this; // one description serves writing and reading, and reading changes
    copy.transfer(root);
  });
}

template <int dim>
void ExplicitRun<dim>::read_checkpoint(const std::filesystem::path& file, const std::string& identity)
{
  read_path_checkpoint(file, identity, [&](Hdf5Reader& root) { transfer(root); });
}

template class ExplicitRun<2>;
template class ExplicitRun<3>;
} // namespace feldspar

#include "dem/lab/laboratory_run.h"

#include "base/mapped.h"
#include "base/parameter_id.h"
#include "dem/lab/cracks.h"
#include "dem/lab/seating.h"
#include "dem/lab/servo.h"
#include "dem/specimen/fragments.h"
#include "dem/specimen/rigid_groups.h"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <stdexcept>
#include <string_view>

namespace feldspar
{
namespace
{
template <int dim>
SetUpTest<dim> set_up_of(const LaboratoryCase& test, Specimen<dim> specimen, const TestParameters& wanted,
                         const DynamicsParameters& dynamics)
{
  const std::optional<SetUp<dim>>& set_up = test.protocol.set_up<dim>();
  if (!set_up)
    throw std::logic_error(fmt::format("{} has no set-up in {} dimensions", test.protocol.kind.name, dim));
  check_fills_its_box(specimen);
  return (*set_up)(std::move(specimen), test.confining_pressure, wanted, dynamics);
}

/// Each end that moves at the speed v sends a wave of the stress ρ c v, and v is half of the strain rate times the length; a
/// rigid end throws it back doubled, and both ends do so.
template <int dim>
PeakDemands peak_demands(const Specimen<dim>& body, const TestKind& kind, const double strain_rate,
                         const TestParameters& wanted)
{
  const double speed = wave_speed(body);
  const double length = body.size[kind.pressure_acts_across ? 0 : dim - 1]; // to which the strain refers
  const double from_both_ends = 2.0 * body.bulk_density * speed * strain_rate * length;
  return {.least_stress = wanted.least_peak_stress.value_or(kind.tilts ? 0.0 : from_both_ends),
          .least_time = wanted.least_transits_to_peak * body.size[dim - 1] / speed,
          .least_fall = wanted.least_fall_after_peak,
          .end_over_peak_strain = wanted.stop_strain_over_peak_strain};
}

std::string what_bears_nothing(const TestRecord& record, const TestParameters& wanted, const double modulus)
{
  const double percent = 100.0 * std::abs(record.curve.back().axial_strain);
  if (record.notch)
    return fmt::format(
      "no bond broke up to a strain of {:.0f} %: the body does not bear between its rollers; one that is "
      "a few grains thick may fall aside: make it larger, or its grains smaller ({})",
      percent, in_words(parameter_id<&SpecimenParameters::minimum_radius>()));
  // Rock breaks at strains of a ten thousandth. Where waves bring about more than that, they hide whether the body holds.
  if (!wanted.least_peak_stress && record.peak_demands.least_stress > 1e-4 * modulus)
    return fmt::format(
      "the rate, {:.3g} 1/s, is too high: waves alone bring about {:.3g} MPa ({}), and the stress stayed "
      "below this up to a strain of {:.0f} %; lower the rate",
      record.strain_rate, record.peak_demands.least_stress / 1e6,
      in_words(parameter_id<&TestParameters::least_peak_stress>()), percent);
  return fmt::format("the stress stayed below {:.3g} MPa ({}) up to a strain of {:.0f} %: nothing "
                     "holds the specimen, or it has no strength",
                     record.peak_demands.least_stress / 1e6,
                     in_words(parameter_id<&TestParameters::least_peak_stress>()), percent);
}

/// The row itself. Throws Runaway for numbers that went wrong, so that the curve ends before them.
template <int dim>
CurveSample checked(const CurveSample& row, const Dynamics<dim>& dynamics)
{
  if (const std::string_view column = not_finite_in(row); !column.empty())
    throw dynamics.runaway(fmt::format("{} is not finite", column));
  return row;
}

template <int dim>
double mean_lateral_strain(const Tensor<dim>& gradient)
{
  return (gradient.trace() - gradient(dim - 1, dim - 1)) / (dim - 1);
}

} // namespace

template <int dim>
LabTest<dim>::LabTest(const LaboratoryCase& test, Specimen<dim> specimen, const TestParameters& parameters,
                      const DynamicsParameters& dynamics)
  : wanted(parameters)
  , stop_rule(test.protocol.kind, test.confining_pressure, {})
  , set_up(set_up_of(test, std::move(specimen), parameters, dynamics))
  , stage_walk(parameters)
  , emission(set_up.dynamics.specimen(), parameters.of<EmissionParameters>())
{
  const Specimen<dim>& tested = set_up.dynamics.specimen();
  record.kind = test.protocol.kind;
  record.confining_pressure = test.confining_pressure;
  record.intermediate_stress = set_up.loading.intermediate_stress;
  record.seed = tested.seed;
  record.has_servo = bool(set_up.loading.servo_stress);
  record.strain_rate = std::abs(set_up.loading.strain_rate);
  record.stress_rate = set_up.loading.stress_rate;
  record.rate_over_laboratory = set_up.loading.rate_over_laboratory;
  record.size = in_space<dim>(tested.size);
  record.specimen = tested.report;
  record.bulk_density = tested.bulk_density;
  record.minerals = shares_of_minerals(tested);
  record.notch = set_up.loading.notch;
  record.normal_stiffness = set_up.loading.normal_stiffness;
  record.way_to_grains = set_up.loading.way_to_grains;
  record.peak_demands = peak_demands(tested, test.protocol.kind, record.strain_rate, wanted);
  record.peak_demands.stress_rate = std::isnan(record.stress_rate) ? 0.0 : record.stress_rate;
  stop_rule = StopRule(test.protocol.kind, test.confining_pressure, record.peak_demands);
  stop_rule.needs_crack = record.notch.has_value(); // a slender body
  n_broken_segments.assign(tested.grains.size(), 0);
  is_part = grains_of_body(tested);
  if (!test.protocol.kind.tilts)
    set_up.dynamics.set_gravity(gravity_of<dim>(parameters));
}

template <int dim>
void LabTest<dim>::start_gauge()
{
  const Specimen<dim>& specimen = set_up.dynamics.specimen();
  gauge = StrainGauge<dim>(specimen.size, specimen.shape, BodyCentres<dim>(specimen, gauge_positions).all(), is_part);
  mineral_gauge = MineralGauge<dim>(specimen, gauge_positions, is_part);
}

template <int dim>
bool LabTest<dim>::advance(const std::function<void()>& check)
{
  const auto clock = std::chrono::steady_clock::now();
  try
    {
      if (!seated)
        seat(check);
      load_to_next_row(check);
      const CurveSample& row = record.curve.back();
      ended =
        set_up.loading.drive_stage ? stage_walk.is_over(record.curve, moment()) : stop_rule.is_met_by(row, wanted);
      if (!set_up.loading.drive_stage && stop_rule.bears_nothing(row, wanted))
        record.failure = what_bears_nothing(record, wanted, set_up.dynamics.specimen().particle_contact.modulus);
    }
  catch (const Runaway& error)
    {
      record.failure = error.what();
      ended = true;
    }
  wall_time += std::chrono::duration<double>(std::chrono::steady_clock::now() - clock).count();
  return !ended;
}

template <int dim>
void LabTest<dim>::seat(const std::function<void()>& check)
{
  auto& dynamics = set_up.dynamics;
  if (set_up.loading.seat)
    set_up.loading.seat(dynamics, check);
  if (set_up.loading.shortening)
    shortening_at_start = set_up.loading.shortening(dynamics);
  if (set_up.loading.opening)
    opening_at_start = set_up.loading.opening(dynamics);
  dynamics.know_all_motions();
  gauge_positions = dynamics.specimen().grains.position;
  start_gauge();
  check_gauge();
  time_at_start = time_of_last_row = dynamics.time();
  seated = true;
  record.curve.push_back(checked(sample(), dynamics));
  stop_rule.add(record.curve.back());
  energy_watch.has_grown_without_work(record.curve.back().energies);
  take_snapshot();
  if (set_up.loading.drive_stage)
    stage_walk.begin(moment());
}

template <int dim>
void LabTest<dim>::check_gauge() const
{
  if (stage_walk.needs_lateral_strain() && std::isnan(displacement_gradient()(0, 0)))
    throw ParameterError(parameter_id<&LoadingTable::file>(),
                         "lateral_strain cannot be measured: too few grains with joints in the middle of "
                         "the specimen; make it wider or the grains smaller");
}

template <int dim>
void LabTest<dim>::follow(const LoadingStage& stage)
{
  stage_walk.append(stage);
  if (!seated)
    return;
  check_gauge();
  stage_walk.begin_last(record.curve.size() - 1, moment());
  ended = went_wrong();
}

/// Strain along the last axis, tension positive.
template <int dim>
double LabTest<dim>::axial_strain() const
{
  return set_up.loading.shortening ? shortening_at_start - set_up.loading.shortening(set_up.dynamics)
                                   : set_up.loading.strain_rate * (set_up.dynamics.time() - time_at_start);
}

template <int dim>
void LabTest<dim>::step()
{
  auto& dynamics = set_up.dynamics;
  const auto breaks = dynamics.step();
  lateral_stress_over_time += dynamics.time_step() * lateral_stress();
  const std::vector<CrackBetween> cracks = cracks_of(dynamics, breaks, axial_strain());
  for (const auto& [crack, grain_1, grain_2] : cracks)
    {
      record.cracks.push_back(crack);
      ++(crack.kind == CrackKind::tension ? n_tension : n_shear);
      ++n_broken_segments[grain_1];
      ++n_broken_segments[grain_2];
    }
  emission.follow(dynamics, cracks, record.cracks);
}

template <int dim>
void LabTest<dim>::add_row()
{
  auto& dynamics = set_up.dynamics;
  dynamics.check_motion();
  dynamics.know_all_motions();
  // Rock breaks at strains of a ten thousandth: a step of more passes over all that there is to be followed.
  constexpr double longest = 1e-3;
  const double strain_rate =
    set_up.loading.drive_stage ? stage_walk.strain_rate() : std::abs(set_up.loading.strain_rate);
  if (const double strain = strain_rate * dynamics.time_step(); strain > longest)
    throw Runaway(fmt::format("the loading strains the specimen by {:.2g} in one step, of {:.2g} s, more than {:g}; a "
                              "lower strain rate is needed",
                              strain, dynamics.time_step(), longest));
  CurveSample row = sample();
  if (energy_watch.has_grown_without_work(row.energies))
    throw dynamics.runaway(
      fmt::format("energy grows without work ({:.3g} J more than were put in)", -row.energies.unaccounted()));
  row.lateral_stress = lateral_stress_over_time / (dynamics.time() - time_of_last_row);
  record.curve.push_back(checked(row, dynamics));
  stop_rule.add(row);
  time_of_last_row = dynamics.time();
  lateral_stress_over_time = 0.0;
  if ((record.curve.size() - 1) % rows_between_snapshots == 0)
    take_snapshot();
}

template <int dim>
void LabTest<dim>::load_to_next_row(const std::function<void()>& check)
{
  auto& dynamics = set_up.dynamics;
  const auto& loading = set_up.loading;
  if (loading.drive_stage)
    {
      StageMoment now = moment();
      const auto is_due = [&] {
        return stage_walk.strain_rate() * (dynamics.time() - time_of_last_row) >= loading.sampling_strain ||
               // Led by the lateral strain, the axial one may run and turn round meanwhile.
               (stage_walk.is_led_by_lateral_strain() &&
                std::abs(axial_strain() - record.curve.back().axial_strain) >= loading.sampling_strain);
      };
      do
        {
          check();
          loading.drive_stage(dynamics, stage_walk.demand(now));
          step();
          if (stage_walk.needs_lateral_strain())
            dynamics.know_all_positions();
          now = moment();
        }
      while (!stage_walk.is_at_end_of_stage(now) && !is_due());
    }
  else
    {
      const double next_strain = double(record.curve.size()) * loading.sampling_strain;
      do // at least one step, however long steps are
        {
          check();
          if (loading.drive)
            loading.drive(dynamics, {dynamics.time() - time_at_start, axial_strain(),
                                     loading.opening ? loading.opening(dynamics) - opening_at_start : 0.0});
          step();
        }
      while (std::abs(axial_strain()) < next_strain);
    }
  add_row();
}

template <int dim>
StageMoment LabTest<dim>::moment() const
{
  const EndStress stress = set_up.loading.end_stress(set_up.dynamics);
  StageMoment now{set_up.dynamics.time(), -axial_strain(), -0.5 * (stress.lower + stress.upper)};
  if (stage_walk.needs_lateral_strain())
    now.lateral_strain = -mean_lateral_strain<dim>(displacement_gradient());
  return now;
}

template <int dim>
double LabTest<dim>::lateral_stress() const
{
  return record.has_servo ? set_up.loading.servo_stress(set_up.dynamics) : 0.0 - record.confining_pressure; // no -0
}

template <int dim>
Tensor<dim> LabTest<dim>::displacement_gradient() const
{
  return gauge.displacement_gradient(BodyCentres<dim>(set_up.dynamics.specimen()).all());
}

template <int dim>
CurveSample LabTest<dim>::sample() const
{
  constexpr int axis = dim - 1;
  const auto& dynamics = set_up.dynamics;
  const Specimen<dim>& specimen = dynamics.specimen();
  CurveSample row;
  row.step = dynamics.n_steps();
  row.time = dynamics.time() - time_at_start;
  row.axial_strain = axial_strain();
  const EndStress stress = set_up.loading.end_stress(dynamics);
  row.axial_stress = 0.5 * (stress.lower + stress.upper);
  row.end_stress_difference = stress.upper - stress.lower;
  row.lateral_stress = lateral_stress();
  const double area = specimen.volume() / specimen.size[axis];
  row.mid_stress = -dynamics.force_across(0.5 * specimen.size[axis]) / area; // pulled down from below: tension
  const Tensor<dim> gradient = displacement_gradient();
  row.gauge_axial_strain = gradient(axis, axis);
  row.gauge_volumetric_strain = gradient.trace();
  row.gauge_lateral_strain = mean_lateral_strain<dim>(gradient);
  row.n_tension_cracks = n_tension;
  row.n_shear_cracks = n_shear;
  row.unbalanced_force_ratio = dynamics.unbalanced_force_ratio();
  row.energies = dynamics.energies();
  return row;
}

template <int dim>
Snapshot LabTest<dim>::snapshot() const
{
  const auto& specimen = set_up.dynamics.specimen();
  Snapshot now;
  now.step = set_up.dynamics.n_steps();
  now.axial_strain = record.curve.back().axial_strain;
  now.axial_stress = record.curve.back().axial_stress;
  for (int c = 0; c < dim; ++c)
    now.position[c].assign(specimen.grains.position[c].begin(), specimen.grains.position[c].end());
  for (const Tensor<dim>& stress : set_up.dynamics.grain_stresses())
    {
      const Tensor<dim> symmetric = 0.5 * (stress + stress.transpose());
      std::size_t k = 0;
      for (int a = 0; a < 3; ++a)
        for (int b = a; b < 3; ++b)
          if (auto& component = now.stress[k++]; b < dim)
            component.push_back(symmetric(a, b));
    }
  now.mineral_strain = mineral_gauge.strains(specimen);
  now.fragment = set_up.dynamics.fragments();
  now.n_broken_segments = n_broken_segments;
  return now;
}

/// Takes a snapshot, which the first process alone keeps. The length of the curve is not known beforehand: when there are too
/// many snapshots, every second one is removed. The last one is taken when the test is finished.
template <int dim>
void LabTest<dim>::take_snapshot()
{
  Snapshot now = snapshot();
  snapshots.push_back(set_up.dynamics.sharing().is_first() ? std::move(now) : Snapshot());
  if (snapshots.size() < wanted.snapshots_of(is_part.size()))
    return;
  std::vector<Snapshot> kept;
  for (std::size_t k = 0; k < snapshots.size(); k += 2)
    kept.push_back(std::move(snapshots[k]));
  snapshots = std::move(kept);
  rows_between_snapshots *= 2;
}

template <int dim>
TestOutcome LabTest<dim>::outcome(const bool interrupted, std::vector<Snapshot> shots) const
{
  const Specimen<dim>& specimen = set_up.dynamics.specimen();
  TestOutcome result{record, {}, {}};
  result.record.interrupted = interrupted || !record.failure.empty();
  result.record.stages = stage_walk.records();
  result.record.ended_early = stage_walk.ended_early();
  if (!record.curve.empty()) // of a row that was begun nothing is reported yet
    result.record.cracks.resize(record.curve.back().n_tension_cracks + record.curve.back().n_shear_cracks);
  result.record.events = emission.catalogue(result.record.cracks, time_at_start);
  result.bookkeeping.steps = set_up.dynamics.n_steps();
  if (!record.curve.empty())
    result.bookkeeping.steps_at_laboratory_rate =
      record.rate_over_laboratory * double(record.curve.back().step - record.curve.front().step);
  result.bookkeeping.time_step = set_up.dynamics.time_step();
  result.bookkeeping.wall_time = wall_time;
  // The end, unless a row was begun or numbers went wrong in it.
  if (record.failure.empty() && !shots.empty() && shots.back().step < record.curve.back().step &&
      record.curve.back().step == set_up.dynamics.n_steps())
    shots.push_back(snapshot());
  for (const auto& flaw : specimen.flaws)
    result.appearance.flaws.push_back(
      {flaw.name, flaw.open, mapped<std::array<double, 3>>(flaw.outline, in_space<dim>)});

  // Grains are given as they last stood right if numbers went wrong.
  const bool went_wrong = !record.failure.empty();
  if (went_wrong && shots.empty())
    return result;
  const auto fragment = went_wrong ? shots.back().fragment : fragments(specimen);
  const auto position_of = [&](const std::size_t i) {
    if (!went_wrong)
      return in_space<dim>(at<dim>(specimen.grains.position, i));
    std::array<double, 3> position{};
    for (int c = 0; c < dim; ++c)
      position[c] = shots.back().position[c][i];
    return position;
  };
  const auto loaded =
    std::ranges::max_element(shots, {}, [](const Snapshot& one) { return std::abs(one.axial_stress); });
  const auto mean_stress_of = [&](const std::size_t i) {
    if (loaded == shots.end() || loaded->stress[0].size() <= i)
      return 0.0;
    const auto& stress = loaded->stress; // xx, xy, xz, yy, yz, zz
    return (stress[0][i] + stress[3][i] + (dim == 3 ? stress[5][i] : 0.0)) / dim;
  };
  auto& grains = result.appearance.grains_at_end;
  grains.reserve(specimen.grains.size());
  for (std::size_t i = 0; i < specimen.grains.size(); ++i)
    grains.push_back({in_space<dim>(at<dim>(seated ? gauge_positions : specimen.grains.position, i)), position_of(i),
                      specimen.grains.radius[i], fragment[i], specimen.groups.empty() ? 0 : specimen.groups[i] + 1,
                      mean_stress_of(i), specimen.mineral.empty() ? 0 : specimen.mineral[i] + 1});
  result.record.fragments = fragments_of(grains, dim);
  result.appearance.snapshots = std::move(shots);
  return result;
}

template class LabTest<2>;
template class LabTest<3>;
} // namespace feldspar

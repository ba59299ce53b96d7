#include "coupling/sample/running_sample.h"

#include "base/byte_archive.h"
#include "base/ranks/ranks.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <stdexcept>
#include <string_view>
#include <type_traits>
#include <utility>

namespace feldspar
{
SampleTest::Parts::Parts(const TestCase& which, const SampleParameters& of, const TestParameters& parameters)
  : test(which)
  , sample(of)
  , wanted(parameters)
  , stop_rule(test.kind, test.confining_pressure,
              {.least_stress = parameters.least_peak_stress.value_or(0.0),
               .least_fall = parameters.least_fall_after_peak,
               .end_over_peak_strain = parameters.stop_strain_over_peak_strain})
{
  if (!test.kind.runs_on_finite_elements)
    throw std::invalid_argument(std::string(test.kind.name) + " is not made on finite elements");
  record.kind = test.kind;
  record.body = TestBody::finite_elements;
  record.strain_rate = bookkeeping.time_step = std::numeric_limits<double>::quiet_NaN();
  record.confining_pressure = test.confining_pressure;
  record.peak_demands = stop_rule.demands();
  if (test.kind.follows_stages)
    {
      stage_walk.emplace(wanted);
      stage_row.confining_pressure = wanted.of<LoadingTable>().stages.at(0).confining_pressure;
    }
  bookkeeping.solver_work.emplace();
}

void SampleTest::Parts::take(std::unique_ptr<SampleBody> its_body, const unsigned int events_per_segment)
{
  most_events_per_segment = events_per_segment;
  body = std::move(its_body);
  size = body->size();
  standing.n_points = body->n_points();
  standing.n_segments = body->n_segments();
  record.size = body->box();
  record.minerals = body->minerals();
}

SampleSetUp SampleTest::Parts::set_up()
{
  return {[this](const fem::NewtonReport& report) {
            standing.n_newton_iterations = report.n_iterations;
            standing.n_cascades = report.n_cascades;
            if (watch)
              watch(standing);
          },
          [this] { return gives_up && gives_up(); }};
}

void SampleTest::Parts::seat()
{
  if (const double pressure = pressure_of_last_row(); pressure > 0.0)
    go({SampleTarget::Lead::stress, pressure, pressure});
  height_at_seating = body->top_displacement();
  lateral_strain_at_seating = body->lateral_strain();
  add_row();
  seated = true;
  if (stage_walk)
    stage_walk->begin(stage_moment());
}

void SampleTest::Parts::load()
{
  if (stage_walk)
    return load_by_stage();
  const double pressure = test.confining_pressure;
  const double step = sign() > 0.0 ? sample.tension_step : sample.compression_step;
  const auto& curve = record.curve;
  const bool stress_falls =
    curve.size() > 1 && std::abs(curve.back().axial_stress) < std::abs(curve[curve.size() - 2].axial_stress);
  widens = widens || (may_widen() && stress_falls);
  if (!widens)
    go({SampleTarget::Lead::platens, height_at_seating + sign() * step * double(record.curve.size()) * size.height,
        pressure});
  if (widens)
    {
      if (!steps)
        wanted_width =
          std::max(body->lateral_strain(), lateral_strain_at_seating + curve.back().gauge_lateral_strain) + step;
      go({SampleTarget::Lead::lateral_strain, wanted_width, pressure});
    }
}

bool SampleTest::Parts::is_over()
{
  if (!stage_walk)
    return stop_rule.is_met_by(record.curve.back(), wanted);
  const bool over = stage_walk->is_over(record.curve, stage_moment());
  record.stages = stage_walk->records();
  record.ended_early = stage_walk->ended_early();
  return over;
}

void SampleTest::Parts::go(const SampleTarget& target)
{
  if (!steps)
    steps.emplace(first_steps());
  const std::uint64_t all_events = most_events_per_segment * standing.n_segments;
  const auto most_events = std::max<std::uint64_t>(1, std::uint64_t(sample.most_broken_share * double(all_events)));
  constexpr unsigned int most_cuts_for_breaks = 2;
  while (!steps->finished())
    {
      body->limit_events(avalanche ? all_events : most_events);
      const fem::NewtonReport report = body->solve(target, (steps->next() - steps->done()) / (1.0 - steps->done()));
      ++bookkeeping.solver_work->n_solves;
      bookkeeping.solver_work->n_iterations += report.n_iterations;
      bookkeeping.solver_work->n_cascades += report.n_cascades;
      if (report.converged)
        {
          body->accept();
          steps->succeeded();
          avalanche = false;
          n_cuts_for_breaks = 0;
          gather_cracks();
          note_step(report);
          share_work();
          step_done();
          continue;
        }
      body->reject();
      ++step_on_its_way.n_cuts;
      const bool breaks_too_much = !avalanche && report.n_events > most_events;
      const bool was_cut = steps->cut();
      if (!was_cut && !breaks_too_much)
        {
          record.came_apart = avalanche;
          throw fem::StepFailure(report.failure);
        }
      if (!breaks_too_much)
        continue;
      avalanche = !was_cut || ++n_cuts_for_breaks == most_cuts_for_breaks;
      if (avalanche && may_widen() && !widens)
        {
          // There may be no avalanche at a held width.
          widens = true;
          avalanche = false;
          n_cuts_for_breaks = 0;
          break;
        }
    }
  steps.reset();
}

void SampleTest::Parts::share_work()
{
  const fem::Balance balance = body->rebalance();
  bookkeeping.solver_work->seconds_in_points += balance.mean * ranks::number();
  RankBalance& ranks = bookkeeping.ranks;
  ranks.mean += balance.mean;
  ranks.longest += balance.longest;
  ranks.longest_unmoved += balance.longest_unmoved;
  ranks.n_moves += balance.moved;
}

void SampleTest::Parts::note_step(const fem::NewtonReport& report)
{
  step_on_its_way.step = bookkeeping.steps;
  step_on_its_way.axial_strain = seated ? axial_strain() : 0.0;
  step_on_its_way.n_iterations = report.n_iterations;
  step_on_its_way.n_cascades = report.n_cascades;
  step_on_its_way.residual = report.residuals.back();
  bookkeeping.solver_work->steps.push_back(step_on_its_way);
  step_on_its_way = {};
}

void SampleTest::Parts::gather_cracks()
{
  ++bookkeeping.steps;
  PointBreaks breaks = body->breaks_of_last_step();
  std::vector<Crack>& broken = breaks.cracks;
  const auto n_of = [&](const CrackKind kind) {
    const auto is = [=](const Crack& crack) { return crack.kind == kind; };
    return ranks::sum(std::uint64_t(std::ranges::count_if(broken, is)));
  };
  n_tension += n_of(CrackKind::tension);
  n_shear += n_of(CrackKind::shear);
  const auto gather = [](auto& rows, const auto number) {
    using Row = typename std::remove_reference_t<decltype(rows)>::value_type;
    rows = values_of<Row>(ranks::gathered(bytes_of(rows)));
    std::ranges::stable_sort(rows, [=](const Row& one, const Row& other) { return one.*number < other.*number; });
  };
  gather(broken, &Crack::joint);
  gather(breaks.events, &EmissionEvent::number);
  const double strain = seated ? axial_strain() : 0.0;
  std::map<std::uint64_t, std::uint64_t> event_of_point;
  for (EmissionEvent& event : breaks.events)
    {
      const std::uint64_t number = record.events.size() + 1;
      event_of_point[std::exchange(event.number, number)] = number;
      event.step = bookkeeping.steps;
      event.axial_strain = strain;
      event.time = stage_walk ? stage_row.time : std::numeric_limits<double>::quiet_NaN();
      record.events.push_back(event);
    }
  for (Crack& crack : broken)
    {
      crack.step = bookkeeping.steps;
      crack.axial_strain = strain;
      crack.event = event_of_point.at(crack.joint);
      record.cracks.push_back(crack);
    }
}

void SampleTest::Parts::add_row()
{
  const bool is_first = record.curve.empty();
  CurveSample row;
  row.step = bookkeeping.steps;
  row.axial_strain = axial_strain();
  row.axial_stress = is_first ? -pressure_of_last_row() : body->platen_stress("top");
  row.end_stress_difference = is_first ? 0.0 : body->platen_stress("top") + body->platen_stress("bottom");
  row.lateral_stress = -pressure_of_last_row();
  if (stage_walk)
    row.time = stage_row.time;
  row.mid_stress = body->mean_axial_stress();
  row.gauge_axial_strain = row.axial_strain;
  row.gauge_lateral_strain = body->lateral_strain() - lateral_strain_at_seating;
  row.gauge_volumetric_strain = row.gauge_axial_strain + body->n_lateral_directions() * row.gauge_lateral_strain;
  row.n_tension_cracks = n_tension;
  row.n_shear_cracks = n_shear;
  row.energies = body->energies();
  standing.n_damaged_points = body->n_damaged_points();
  if (const std::string_view column = not_finite_in(row); !column.empty())
    throw fem::StepFailure(fmt::format("numbers went wrong: {} is not finite", column));
  record.curve.push_back(row);
  stop_rule.add(row);
}
} // namespace feldspar

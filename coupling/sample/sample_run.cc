#include "coupling/sample/sample_run.h"

#include "base/input_error.h"
#include "base/parameter_id.h"
#include "coupling/rve/equilibrium.h"
#include "coupling/sample/running_sample.h"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <utility>

namespace feldspar
{
template <int dim>
SampleTest::SampleTest(const TestCase& test, const SampleParameters& sample, const TestParameters& wanted,
                       const EquilibriumParameters& equilibrium, std::vector<Realisation<dim>> realisations,
                       const SpecimenReport& of_rves, const std::uint64_t seed)
  : parts(std::make_unique<Parts>(test, sample, wanted))
{
  const unsigned int events_per_segment = most_events_of_a_bond(*realisations.front().inside, equilibrium);
  parts->take(make_body_of_grains<dim>(sample, parts->set_up(), equilibrium, std::move(realisations), seed),
              events_per_segment);
  parts->record.seed = seed;
  parts->record.specimen = of_rves;
}

SampleTest::SampleTest(const TestCase& test, const SampleParameters& sample, const TestParameters& wanted,
                       const ContinuumParameters& continuum)
  : parts(std::make_unique<Parts>(test, sample, wanted))
{
  parts->take(make_continuous_body(sample, parts->set_up(), continuum), 0);
}
SampleTest::~SampleTest() = default;
SampleTest::SampleTest(SampleTest&&) noexcept = default;

bool SampleTest::advance(const std::function<void(const SampleStanding&)>& watch,
                         const std::function<void()>& step_done, const std::function<bool()>& gives_up)
{
  const auto clock = std::chrono::steady_clock::now();
  parts->watch = watch;
  parts->step_done = step_done;
  parts->gives_up = gives_up;
  TestRecord& record = parts->record;
  try
    {
      if (!parts->seated)
        parts->seat();
      parts->load();
      parts->add_row();
      parts->ended = parts->is_over();
    }
  catch (const fem::StepFailure& failure)
    {
      if (!parts->seated)
        throw ParameterError(parts->stage_walk ? parameter_id<&LoadingTable::file>()
                                               : parameter_id<&TestCase::confining_pressure>(),
                             fmt::format("the sample finds no equilibrium under {:g} MPa: {}",
                                         parts->pressure_of_last_row() / 1e6, failure.what()));
      parts->steps.reset();
      parts->ended = true;
      record.ended_early =
        fmt::format("{} beyond an axial strain of {:.4g} %: {}",
                    record.came_apart ? "it came apart in an avalanche of breaks" : "no equilibrium was found",
                    100.0 * std::abs(parts->axial_strain()), failure.what());
    }
  parts->watch = nullptr;
  parts->step_done = nullptr;
  parts->gives_up = nullptr;
  parts->bookkeeping.wall_time += std::chrono::duration<double>(std::chrono::steady_clock::now() - clock).count();
  return !parts->ended;
}

bool SampleTest::has_ended() const { return parts->ended; }
const CurveSample& SampleTest::last_row() const { return parts->record.curve.back(); }
SampleStanding SampleTest::standing() const { return parts->standing; }

void SampleTest::write_fields(const std::filesystem::path& folder, const std::string& name)
{
  if (!parts->fields)
    parts->fields.emplace(folder, name);
  parts->body->write_fields(*parts->fields, double(parts->record.curve.size()));
}

template <int dim>
SampleRve<dim> SampleTest::rve_at(const unsigned int cell, const unsigned int point) const
{
  const std::size_t n = parts->body->n_points_per_cell();
  if (point >= n || cell >= parts->standing.n_points / n)
    throw InputError("there is no point {} in a cell {}: cells are 0 to {}, their points 0 to {}", point, cell,
                     parts->standing.n_points / n - 1, n - 1);
  return std::get<SampleRve<dim>>(parts->body->rve(n * cell + point).value());
}

template <int dim>
std::optional<SampleRve<dim>> SampleTest::rve_here(const std::uint64_t number) const
{
  const auto rve = parts->body->rve(number);
  return rve ? std::optional(std::get<SampleRve<dim>>(*rve)) : std::nullopt;
}

std::size_t SampleTest::n_points_per_cell() const { return parts->body->n_points_per_cell(); }

std::size_t SampleTest::n_fields_written() const { return parts->fields ? parts->fields->n_written() : 0; }

TestOutcome SampleTest::finish(const bool interrupted) const
{
  TestOutcome outcome{parts->record, {}, parts->bookkeeping};
  TestRecord& record = outcome.record;
  record.interrupted = interrupted;
  const std::uint64_t last = record.curve.empty() ? 0 : record.curve.back().step;
  if (interrupted) // perhaps within a row
    {
      outcome.bookkeeping.steps = last;
      std::erase_if(record.cracks, [=](const Crack& crack) { return crack.step > last; });
      std::erase_if(record.events, [=](const EmissionEvent& event) { return event.step > last; });
      std::erase_if(outcome.bookkeeping.solver_work->steps, [=](const SolverStep& one) { return one.step > last; });
    }
  outcome.bookkeeping.largest_residual = 0.0;
  for (const SolverStep& one : outcome.bookkeeping.solver_work->steps)
    outcome.bookkeeping.largest_residual = std::max(outcome.bookkeeping.largest_residual, one.residual);
  return outcome;
}

template SampleTest::SampleTest(const TestCase&, const SampleParameters&, const TestParameters&,
                                const EquilibriumParameters&, std::vector<Realisation<2>>, const SpecimenReport&,
                                std::uint64_t);
template SampleTest::SampleTest(const TestCase&, const SampleParameters&, const TestParameters&,
                                const EquilibriumParameters&, std::vector<Realisation<3>>, const SpecimenReport&,
                                std::uint64_t);
template SampleRve<2> SampleTest::rve_at<2>(unsigned int, unsigned int) const;
template SampleRve<3> SampleTest::rve_at<3>(unsigned int, unsigned int) const;
template std::optional<SampleRve<2>> SampleTest::rve_here<2>(std::uint64_t) const;
template std::optional<SampleRve<3>> SampleTest::rve_here<3>(std::uint64_t) const;
} // namespace feldspar

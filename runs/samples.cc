#include "runs/samples.h"

#include "base/input_error.h"
#include "base/ranks/ranks.h"
#include "coupling/sample/checkpoints.h"
#include "runs/checkpoints.h"
#include "runs/part.h"

#include <fmt/format.h>

#include <utility>

namespace feldspar
{
namespace
{
SampleTest from_the_start(const PlannedSample& planned)
{
  const SampleSettings& settings = *planned.settings;
  if (!settings.sample.has_grains())
    return {planned.test, settings.sample, settings.tests, settings.continuum};
  return std::visit(
    [&](const auto& packings) {
      return SampleTest(planned.test, settings.sample, settings.tests, settings.equilibrium, packings.realisations,
                        packings.specimens.front().report, planned.rock->seed);
    },
    planned.rock->packings);
}

/// The states of a test in the folder of its run, as Checkpoints are those of a test on grains.
struct SampleStates
{
  const PlannedSample& planned;
  const std::filesystem::path& folder;

  void write(const SampleTest& test) const { test.write_state(state_folder(folder, planned), planned.identity); }
};

FinishedTest run_sample(const PlannedSample& planned, const std::filesystem::path& folder, const std::size_t part,
                        RunObserver& observer)
{
  SampleTest test = open(planned, folder, observer);
  const double sign = planned.test.kind.sign;
  const double strain_between_fields = sign > 0.0 ? 2.5e-5 : 2.5e-4;
  const auto draw = [&](const SampleStanding& standing) {
    if (ranks::any(observer.wants_end()))
      throw Interrupted();
    if (standing.n_newton_iterations + standing.n_cascades > 0)
      observer.advanced(part, {nullptr, 0.0,
                               fmt::format(", {} iterations and {} cascades in this step", standing.n_newton_iterations,
                                           standing.n_cascades)});
  };
  const auto advance = [&](const auto& keep_if_due) {
    try
      {
        test.advance(draw, keep_if_due, [&] { return observer.wants_end(); });
      }
    catch (const Interrupted&) // at the last step, which is no row
      {
        return true;
      }
    const CurveSample& row = test.last_row();
    const SampleStanding standing = test.standing();
    observer.advanced(
      part, {&row, 0.0,
             fmt::format(", {} broken segments, {:.0f} % of points damaged", row.n_tension_cracks + row.n_shear_cracks,
                         100.0 * double(standing.n_damaged_points) / double(standing.n_points))});
    if (sign * row.axial_strain >= double(test.n_fields_written()) * strain_between_fields || test.has_ended())
      test.write_fields(folder / "fields", planned.name);
    return true;
  };
  std::string failure;
  try
    {
      lead(test, SampleStates{planned, folder}, observer, 0, advance, ranks::any);
    }
  catch (const InputError& error) // a confinement it cannot bear; other tests may
    {
      failure = error.what();
    }
  const bool was_interrupted = failure.empty() && !test.has_ended();
  TestOutcome outcome = test.finish(was_interrupted);
  outcome.record.failure = failure;
  if (!was_interrupted && failure.empty())
    outcome.appearance.rves = point_rves(planned, test, outcome.record);
  return finished(std::move(outcome), planned.group, planned.name, "");
}
} // namespace

std::vector<SpecimenReport> Rock::reports() const
{
  std::vector<SpecimenReport> all;
  std::visit(
    [&](const auto& of) {
      for (std::size_t k = 0; k < of.n_packed; ++k)
        all.push_back(of.specimens[k].report);
    },
    packings);
  return all;
}

std::filesystem::path state_folder(const std::filesystem::path& folder, const PlannedSample& planned)
{
  return folder / "states" / planned.name;
}

SampleTest open(const PlannedSample& planned, const std::filesystem::path& folder, RunObserver& observer)
{
  return last_good(
    checkpoints_in(state_folder(folder, planned)), [&] { return from_the_start(planned); },
    [&](SampleTest& test, const std::filesystem::path& checkpoint) {
      test.read_state(checkpoint, planned.identity, folder / "fields", planned.name);
    },
    [&](const std::string& sentence) {
      if (ranks::is_first()) // all of them find the same
        observer.goes_back(sentence);
    });
}

std::vector<FinishedTest> run_samples(const std::vector<PlannedSample>& planned, const std::filesystem::path& folder,
                                      RunObserver& observer)
{
  ranks::first([&] { std::filesystem::create_directories(folder / "fields"); });
  std::vector<FinishedTest> tests;
  for (const PlannedSample& one : planned)
    {
      if (ranks::any(observer.wants_end()))
        break;
      const std::size_t part = tests.size();
      tests.push_back(run_sample(one, folder, part, observer));
      observer.ended(part);
    }
  return tests;
}
} // namespace feldspar

#include "app/programme/multiscale_run.h"

#include "app/programme/checks.h"
#include "app/programme/point_rves.h"
#include "app/programme/sample_checks.h"
#include "app/programme/specimen_source.h"
#include "app/run/checkpoints.h"
#include "app/run/interrupt.h"
#include "app/run/run_record.h"
#include "base/input_error.h"
#include "base/ranks/ranks.h"
#include "coupling/sample/checkpoints.h"
#include "coupling/sample/grain_material.h"
#include "laboratory/loading_stages.h"

#include <Eigen/LU>
#include <fmt/format.h>

#include <algorithm>
#include <cstdio>

namespace feldspar
{
namespace
{
std::vector<std::uint64_t> packing_seeds(const Input& input)
{
  std::vector<std::uint64_t> seeds;
  for (const std::uint64_t seed : input.seeds)
    for (std::uint64_t k = 0; k < input.sample.n_realisations; ++k)
      seeds.push_back(seed * input.sample.n_realisations + k);
  return seeds;
}

/// Folder of the specimens of the RVEs; runs of 0.2.0 have them in `volumes`.
std::filesystem::path folder_of_rves(const std::filesystem::path& folder)
{
  const std::filesystem::path earlier = folder / "volumes";
  return std::filesystem::exists(earlier) ? earlier : folder / "rves";
}

SampleTest from_the_start(const PlannedSample& planned, const Input& input)
{
  if (!input.sample.has_grains())
    return {planned.test, input.sample, input.tests, input.continuum};
  return std::visit(
    [&](const auto& packings) {
      return SampleTest(planned.test, input.sample, input.tests, input.equilibrium, packings.as_packed(),
                        packings.weak_twins(), packings.specimens.front().report, planned.rock->seed);
    },
    planned.rock->packings);
}

template <int dim>
std::vector<Rock> make_rocks(const Input& input, const std::filesystem::path& input_file,
                             const std::filesystem::path& folder, Progress& progress)
{
  Input of_packings = input;
  of_packings.seeds = packing_seeds(input);
  const std::vector<Variant> one{{"", of_packings}};
  const auto orders = specimen_orders(one);
  const std::filesystem::path of_rves = folder_of_rves(folder);
  ranks::first([&] { std::filesystem::create_directories(of_rves); });
  if (ranks::number() > 1)
    {
      // Each rank makes its share; then all read all.
      std::vector<SpecimenOrder> own;
      for (std::size_t k = ranks::mine(); k < orders.size(); k += ranks::number())
        own.push_back(orders[k]);
      bool was_interrupted = false;
      ranks::together([&] {
        try
          {
            if (!own.empty())
              provide_specimens<dim>(one, own, of_rves, progress);
          }
        catch (const Interrupted&)
          {
            was_interrupted = true;
          }
      });
      if (ranks::any(was_interrupted))
        throw Interrupted();
    }
  auto specimens = provide_specimens<dim>(one, orders, of_rves, progress);
  std::vector<Rock> rocks;
  for (std::size_t k = 0; k < specimens.size(); ++k)
    {
      with_name_of(input_file, [&] { check_cell(specimens[k], "the RVE at a point"); });
      if (k % input.sample.n_realisations == 0)
        rocks.push_back({input.seeds[rocks.size()], Packings<dim>()});
      auto& packings = std::get<Packings<dim>>(rocks.back().packings);
      packings.realisations.push_back(realisation(specimens[k], input.boundary));
      with_name_of(input_file, [&] { check_intact(input, *packings.realisations.back().inside); });
      packings.specimens.push_back(std::move(specimens[k]));
      ++packings.n_packed;
    }
  if (input.sample.weak_seed != WeakSeed::none)
    for (Rock& rock : rocks)
      {
        auto& packings = std::get<Packings<dim>>(rock.packings);
        for (std::size_t k = 0; k < packings.n_packed; ++k)
          {
            packings.specimens.push_back(weakened<dim>(packings.specimens[k], input.sample.weak_seed_strength));
            packings.realisations.push_back(realisation(packings.specimens.back(), input.boundary));
          }
      }
  return rocks;
}
} // namespace

std::vector<Rock> make_rocks(const Input& input, const std::filesystem::path& input_file,
                             const std::filesystem::path& folder, Progress& progress)
{
  if (!input.sample.has_grains())
    return {{input.seeds.front(), {}}}; // no seed makes a difference
  return input.specimen.dimension == 2 ? make_rocks<2>(input, input_file, folder, progress)
                                       : make_rocks<3>(input, input_file, folder, progress);
}

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

namespace
{
/// An RVE withstands any pressure, even one that presses its grains into each other so far that the result means
/// nothing.
template <int dim>
void check_confinement(const double pressure, const char* const entry, const Network<dim>& network)
{
  constexpr double largest = 0.01;
  const Voigt<dim> all_round = stress_voigt<dim>(-pressure * Tensor<dim>::Identity());
  const Voigt<dim> strain = network.intact_stiffness().partialPivLu().solve(all_round);
  if (const double size = strain.cwiseAbs().maxCoeff(); size > largest)
    throw InputError(fmt::format("{}: {:g} MPa would strain the intact RVE by {:.2g} %; a pressure may strain "
                                 "it by {:g} % at most, which is {:.0f} MPa",
                                 entry, pressure / 1e6, 100.0 * size, 100.0 * largest,
                                 pressure * largest / size / 1e6));
}
} // namespace

std::vector<PlannedSample> plan(const Input& input, const std::vector<Rock>& rocks)
{
  for (const Rock& rock : rocks)
    std::visit(
      [&](const auto& packings) {
        if (packings.realisations.empty())
          return;
        if (any_takes_confining_pressure(input.test_list))
          for (const double pressure : input.confinements)
            check_confinement(pressure, "Tests/Confinements", *packings.realisations.front().inside);
        for (const LoadingStage& stage : input.tests.of<LoadingTable>().stages)
          check_confinement(stage.confining_pressure, "Tests/Loading table", *packings.realisations.front().inside);
      },
      rock.packings);
  std::vector<PlannedSample> planned;
  for (const Rock& rock : rocks)
    for (const TestCase& test : test_cases(input.test_list, input.confinements))
      {
        const std::string group = name(test);
        const std::string full_name = fmt::format("{}_seed_{}", group, rock.seed);
        planned.push_back({test, &rock, group, full_name, run_identity(input, full_name)});
      }
  return planned;
}

std::filesystem::path state_folder(const std::filesystem::path& folder, const PlannedSample& planned)
{
  return folder / "states" / planned.name;
}

SampleTest open(const PlannedSample& planned, const Input& input, const std::filesystem::path& folder)
{
  return last_good(
    checkpoints_in(state_folder(folder, planned)), [&] { return from_the_start(planned, input); },
    [&](SampleTest& test, const std::filesystem::path& checkpoint) {
      test.read_state(checkpoint, planned.identity, folder / "fields", planned.name);
    },
    ranks::is_first());
}

FinishedTest run_test(const PlannedSample& planned, const Input& input, const std::filesystem::path& folder,
                      const SampleListener& show)
{
  SampleTest test = open(planned, input, folder);
  CheckpointClock clock;
  const auto write_state = [&] {
    clock.time([&] { test.write_state(state_folder(folder, planned), planned.identity); });
  };
  const double sign = planned.test.kind.sign;
  const double strain_between_fields = planned.test.kind.sign > 0.0 ? 2.5e-5 : 2.5e-4;
  const auto draw = [&](const SampleStanding& standing) {
    if (ranks::any(interrupted()))
      throw Interrupted();
    if (standing.n_newton_iterations + standing.n_cascades > 0)
      show(nullptr, fmt::format(", {} iterations and {} cascades in this step", standing.n_newton_iterations,
                                standing.n_cascades));
  };
  bool was_interrupted = false;
  std::string failure;
  try
    {
      while (!test.has_ended())
        {
          const auto keep = [&] {
            if (ranks::any(ranks::is_first() && clock.is_due()))
              write_state();
          };
          test.advance(draw, keep, interrupted);
          const CurveSample& row = test.last_row();
          const SampleStanding standing = test.standing();
          show(&row, fmt::format(", {} broken segments, {:.0f} % of points damaged",
                                 row.n_tension_cracks + row.n_shear_cracks,
                                 100.0 * double(standing.n_damaged_points) / double(standing.n_points)));
          if (sign * row.axial_strain >= double(test.n_fields_written()) * strain_between_fields || test.has_ended())
            test.write_fields(folder / "fields", planned.name);
          if (test.has_ended())
            write_state();
        }
    }
  catch (const Interrupted&)
    {
      was_interrupted = true;
      write_state();
    }
  catch (const InputError& error) // a confinement it cannot withstand; other tests may
    {
      failure = error.what();
    }
  TestOutcome outcome = test.finish(was_interrupted);
  outcome.record.failure = failure;
  if (!was_interrupted && failure.empty())
    outcome.appearance.rves = point_rves(planned, test, outcome.record);
  return finished(std::move(outcome), planned.group, planned.name, "");
}
} // namespace feldspar

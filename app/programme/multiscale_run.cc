#include "app/programme/multiscale_run.h"

#include "app/programme/checks.h"
#include "app/programme/sample_checks.h"
#include "app/programme/specimen_source.h"
#include "app/run/run_record.h"
#include "base/input_error.h"
#include "base/ranks/ranks.h"
#include "coupling/sample/grain_material.h"
#include "coupling/sample/sample_body.h"
#include "laboratory/loading_stages.h"

#include <Eigen/LU>
#include <fmt/format.h>

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

template <int dim>
std::vector<Rock> make_rocks(const Input& input, const std::filesystem::path& input_file,
                             const std::filesystem::path& folder, Progress& progress)
{
  std::vector<Rock> rocks;
  for (const std::uint64_t seed : input.seeds)
    rocks.push_back({seed, Packings<dim>()});
  for (const Variant& of_cells : rocks_of_sample(input))
    {
      Input of_packings = of_cells.input;
      of_packings.variants = {};
      of_packings.seeds = packing_seeds(input);
      const RunPlan plan(of_packings);
      const std::filesystem::path of_rves = folder_of_rves(folder) / of_cells.name_in_files;
      ranks::first([&] { std::filesystem::create_directories(of_rves); });
      if (ranks::number() > 1) // each rank makes its share; then all read all
        share_out_specimens<dim>(plan, of_rves, progress);
      auto specimens = provide_specimens<dim>(plan, of_rves, progress);
      for (std::size_t k = 0; k < specimens.size(); ++k)
        {
          with_name_of(input_file, [&] { check_cell(specimens[k].shape, "the RVE at a point"); });
          auto& packings = std::get<Packings<dim>>(rocks[k / input.sample.n_realisations].packings);
          packings.realisations.push_back(realisation(specimens[k], input.boundary));
          packings.realisations.back().rock = of_cells.label;
          with_name_of(input_file, [&] { check_intact(input, *packings.realisations.back().inside); });
          packings.specimens.push_back(std::move(specimens[k]));
          ++packings.n_packed;
        }
    }
  if (input.sample.weak_seed != WeakSeed::none)
    for (Rock& rock : rocks)
      {
        auto& packings = std::get<Packings<dim>>(rock.packings);
        for (std::size_t k = 0; k < packings.n_packed; ++k)
          {
            packings.specimens.push_back(weakened<dim>(packings.specimens[k], input.sample.weak_seed_strength));
            packings.realisations.push_back(realisation(packings.specimens.back(), input.boundary));
            packings.realisations.back().rock = rock_of_weak_seed;
          }
      }
  return rocks;
}

/// An RVE withstands any pressure, even one that presses its grains into each other so far that the result means
/// nothing.
template <int dim>
void check_confinement(const double pressure, const char* const entry, const Network<dim>& network)
{
  constexpr double largest = 0.01;
  const Voigt<dim> all_round = stress_voigt<dim>(-pressure * Tensor<dim>::Identity());
  const Voigt<dim> strain = network.intact_stiffness().partialPivLu().solve(all_round);
  if (const double size = strain.cwiseAbs().maxCoeff(); size > largest)
    throw InputError("{}: {:g} MPa would strain the intact RVE by {:.2g} %; a pressure may strain "
                     "it by {:g} % at most, which is {:.0f} MPa",
                     entry, pressure / 1e6, 100.0 * size, 100.0 * largest, pressure * largest / size / 1e6);
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

SampleSettings sample_settings(const Input& input)
{
  return {input.sample, input.tests, input.equilibrium, input.continuum};
}

std::vector<PlannedSample> plan(const Input& input, const std::vector<Rock>& rocks, const SampleSettings& settings)
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
        planned.push_back({test, &rock, &settings, group, full_name, run_identity(input, full_name)});
      }
  return planned;
}
} // namespace feldspar

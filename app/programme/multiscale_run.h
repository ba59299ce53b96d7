#pragma once

#include "app/input/input.h"
#include "app/screen/progress.h"
#include "coupling/sample/sample_run.h"
#include "dem/specimen/specimen.h"
#include "results/runs/run.h"

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <memory>
#include <string>
#include <variant>
#include <vector>

/// The parts of a multiscale run: its RVEs, its programme, and one test of it.
namespace feldspar
{
/// The RVEs that one seed's samples share: as they were packed, then, where there is a weak seed, their weak twins.
template <int dim>
struct Packings
{
  using Realisations = std::vector<Realisation<dim>>;

  std::vector<Specimen<dim>> specimens;
  Realisations realisations; ///< of the specimens; shared by the points that got them
  std::size_t n_packed = 0;

  Realisations as_packed() const { return {realisations.begin(), realisations.begin() + std::ptrdiff_t(n_packed)}; }
  Realisations weak_twins() const { return {realisations.begin() + std::ptrdiff_t(n_packed), realisations.end()}; }

  /// Number of the realisation to which a network belongs.
  std::size_t realisation_of(const Network<dim>& network) const
  {
    const auto is_it = [&](const auto& one) { return one.inside.get() == &network || one.at_side.get() == &network; };
    return std::size_t(std::find_if(realisations.begin(), realisations.end(), is_it) - realisations.begin());
  }
};

struct Rock
{
  std::uint64_t seed;
  std::variant<Packings<2>, Packings<3>> packings; ///< none in a sample without grains

  /// Reports on the RVEs as they came out.
  std::vector<SpecimenReport> reports() const;
};

/// Makes the RVEs of every seed, each on one rank, or reads those that lie in the folder of the run. Collective, as
/// everything here. Throws InputError, and Interrupted.
std::vector<Rock> make_rocks(const Input& input, const std::filesystem::path& input_file,
                             const std::filesystem::path& folder, Progress& progress);

struct PlannedSample
{
  TestCase test;
  const Rock* rock;
  std::string group;
  std::string name;
  std::string identity; ///< of its state: program, input and test
};

/// The rocks must outlive it.
std::vector<PlannedSample> plan(const Input& input, const std::vector<Rock>& rocks);

/// The checkpoints of a test in the folder of its run.
std::filesystem::path state_folder(const std::filesystem::path& folder, const PlannedSample& planned);

/// The test as its last checkpoint in the folder has it; where that cannot be used, which is said, as the one before it
/// has it, else from the start.
SampleTest open(const PlannedSample& planned, const Input& input, const std::filesystem::path& folder);

/// Hears of every row of a test, and, with none, of the work between two rows; and what else is to be said.
using SampleListener = std::function<void(const CurveSample* row, const std::string& more)>;

/// Runs a test to its end, or to Ctrl-C.
FinishedTest run_test(const PlannedSample& planned, const Input& input, const std::filesystem::path& folder,
                      const SampleListener& show);
} // namespace feldspar

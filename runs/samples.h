#pragma once

#include "coupling/sample/sample_run.h"
#include "dem/specimen/specimen.h"
#include "results/runs/run.h"
#include "runs/observer.h"

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <string>
#include <variant>
#include <vector>

/// Tests on samples of finite elements. All processes make each test together: every function is collective.
namespace feldspar
{
/// The RVEs that one seed's samples share: as they were packed, those of the input's rock first; then, where there is a weak
/// seed, their weak twins.
template <int dim>
struct Packings
{
  std::vector<Specimen<dim>> specimens;
  std::vector<Realisation<dim>> realisations; ///< of the specimens; shared by the points that got them
  std::size_t n_packed = 0;

  /// Number of the realisation to which a network belongs.
  std::size_t realisation_of(const Network<dim>& network) const
  {
    const auto is_it = [&](const auto& one) { return one.inside.get() == &network || one.at_side.get() == &network; };
    return std::size_t(std::ranges::find_if(realisations, is_it) - realisations.begin());
  }
};

struct Rock
{
  std::uint64_t seed;
  std::variant<Packings<2>, Packings<3>> packings; ///< none in a sample without grains

  /// Reports on the RVEs as they were made.
  std::vector<SpecimenReport> reports() const;
};

/// Parameters of the samples of a run.
struct SampleSettings
{
  SampleParameters sample;
  TestParameters tests;
  EquilibriumParameters equilibrium; ///< of samples with grains
  ContinuumParameters continuum;     ///< of others
};

/// A test on a sample that is to be made.
struct PlannedSample
{
  TestCase test;
  const Rock* rock; ///< outlives the run, as the settings
  const SampleSettings* settings;
  std::string group;
  std::string name;
  std::string identity; ///< of its state: program, input and test
};

/// The checkpoints of a test in the folder of its run.
std::filesystem::path state_folder(const std::filesystem::path& folder, const PlannedSample& planned);

/// The test as its last checkpoint in the folder has it; where that cannot be used, which the observer hears, as the one before
/// it has it, else from the start.
SampleTest open(const PlannedSample& planned, const std::filesystem::path& folder, RunObserver& observer);

/// Runs tests in the folder of their run one after the other, each to its end, or to where the observer of any process wants
/// the end; tests that had not begun are then not in the results.
std::vector<FinishedTest> run_samples(const std::vector<PlannedSample>& planned, const std::filesystem::path& folder,
                                      RunObserver& observer);

/// The RVEs of a test that the report shows, as they are at its last step: the point with most broken segments (of
/// equals that of the lowest number), the median of the damaged ones, and of those where nothing broke the middle one by
/// number, or the least damaged. None of a sample without grains.
/// `record` is what the test leaves. Collective; the first rank gets them.
std::vector<PointRve> point_rves(const PlannedSample& planned, const SampleTest& test, const TestRecord& record);
} // namespace feldspar

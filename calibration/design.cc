#include "calibration/design.h"

#include "calibration/open_turns_function.h"

#include <openturns/ComposedDistribution.hxx>
#include <openturns/LowDiscrepancyExperiment.hxx>
#include <openturns/MartinezSensitivityAlgorithm.hxx>
#include <openturns/RandomGenerator.hxx>
#include <openturns/SobolSequence.hxx>
#include <openturns/TBB.hxx>
#include <openturns/Uniform.hxx>

namespace feldspar::calibration
{
namespace
{
OT::ComposedDistribution unit_cube(const std::size_t dimension)
{
  return OT::ComposedDistribution(
    OT::ComposedDistribution::DistributionCollection(dimension, OT::Distribution(OT::Uniform(0.0, 1.0))));
}
} // namespace

std::vector<UnitPoint> sobol_points(const std::size_t n, const std::size_t dimension, const std::uint64_t seed)
{
  OT::RandomGenerator::SetSeed(seed);
  OT::LowDiscrepancyExperiment experiment(OT::SobolSequence(), unit_cube(dimension), n, true);
  experiment.setRandomize(true);
  const OT::Sample sample = experiment.generate();
  std::vector<UnitPoint> points(n, UnitPoint(dimension));
  for (std::size_t i = 0; i < n; ++i)
    for (std::size_t k = 0; k < dimension; ++k)
      points[i][k] = sample(i, k);
  return points;
}

SobolIndices sobol_indices(const std::function<double(const UnitPoint&)>& f, const std::size_t dimension,
                           const std::size_t n, const std::uint64_t seed)
{
  // Threads of OpenTURNS are not used: its sums over the sample would take their order, and the last bit would differ
  // from run to run.
  OT::TBB::Disable();
  OT::RandomGenerator::SetSeed(seed);
  const OT::Function function(OpenTurnsFunction(f, dimension));
  OT::MartinezSensitivityAlgorithm algorithm(unit_cube(dimension), n, function, false);
  algorithm.setUseAsymptoticDistribution(true); // else it would draw hundreds of samples for intervals nobody reads
  const OT::Point first = algorithm.getFirstOrderIndices();
  const OT::Point total = algorithm.getTotalOrderIndices();
  return {{first.begin(), first.end()}, {total.begin(), total.end()}};
}
} // namespace feldspar::calibration

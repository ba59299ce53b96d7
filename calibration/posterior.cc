#include "calibration/posterior.h"

#include "calibration/open_turns_function.h"

#include <openturns/Normal.hxx>
#include <openturns/RandomGenerator.hxx>
#include <openturns/RandomWalkMetropolisHastings.hxx>

namespace feldspar::calibration
{
std::vector<std::vector<double>> metropolis(const std::function<double(const std::vector<double>&)>& log_density,
                                            const std::vector<double>& lower, const std::vector<double>& upper,
                                            const std::vector<double>& start,
                                            const std::vector<std::vector<double>>& covariance, const std::size_t n,
                                            const std::uint64_t seed)
{
  const std::size_t dimension = start.size();
  OT::RandomGenerator::SetSeed(seed);
  OT::CovarianceMatrix of_step(dimension);
  for (std::size_t i = 0; i < dimension; ++i)
    for (std::size_t k = 0; k <= i; ++k)
      of_step(i, k) = 2.38 * 2.38 / double(dimension) * covariance[i][k];
  constexpr std::size_t thinning = 5; // neighbours of a chain are much alike
  OT::RandomWalkMetropolisHastings chain(OT::Function(OpenTurnsFunction(log_density, dimension)),
                                         OT::Interval(as_point(lower), as_point(upper)), as_point(start),
                                         OT::Normal(OT::Point(dimension, 0.0), of_step));
  chain.setBurnIn(thinning * n / 4);
  chain.setThinning(thinning);
  const OT::Sample sample = chain.getSample(n);
  std::vector<std::vector<double>> points(n, std::vector<double>(dimension));
  for (std::size_t i = 0; i < n; ++i)
    for (std::size_t k = 0; k < dimension; ++k)
      points[i][k] = sample(i, k);
  return points;
}
} // namespace feldspar::calibration

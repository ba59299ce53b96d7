#include "calibration/open_turns.h"

#include <openturns/ComposedDistribution.hxx>
#include <openturns/EvaluationImplementation.hxx>
#include <openturns/Function.hxx>
#include <openturns/KrigingAlgorithm.hxx>
#include <openturns/LinearBasisFactory.hxx>
#include <openturns/Log.hxx>
#include <openturns/LowDiscrepancyExperiment.hxx>
#include <openturns/MartinezSensitivityAlgorithm.hxx>
#include <openturns/MaternModel.hxx>
#include <openturns/Normal.hxx>
#include <openturns/RandomGenerator.hxx>
#include <openturns/RandomWalkMetropolisHastings.hxx>
#include <openturns/ResourceMap.hxx>
#include <openturns/SobolSequence.hxx>
#include <openturns/TBB.hxx>
#include <openturns/Uniform.hxx>

#include <algorithm>
#include <cmath>
#include <utility>

namespace feldspar::calibration
{
namespace
{
OT::Point as_point(const std::vector<double>& values)
{
  OT::Point point(values.size());
  std::ranges::copy(values, point.begin());
  return point;
}

std::vector<std::vector<double>> as_points(const OT::Sample& sample)
{
  std::vector<std::vector<double>> points(sample.getSize(), std::vector<double>(sample.getDimension()));
  for (std::size_t i = 0; i < points.size(); ++i)
    for (std::size_t k = 0; k < points[i].size(); ++k)
      points[i][k] = sample(i, k);
  return points;
}

/// A function of ours as OpenTURNS calls it.
class OpenTurnsFunction : public OT::EvaluationImplementation
{
public:
  OpenTurnsFunction(FunctionOfPoint function, const std::size_t n)
    : f(std::move(function))
    , dimension(n)
  {
  }

  OpenTurnsFunction* clone() const override { return new OpenTurnsFunction(*this); } // owned by its smart pointer

  using OT::EvaluationImplementation::operator();

  OT::Point operator()(const OT::Point& point) const override
  {
    return OT::Point(1, f(std::vector<double>(point.begin(), point.end())));
  }

  OT::UnsignedInteger getInputDimension() const override { return dimension; }
  OT::UnsignedInteger getOutputDimension() const override { return 1; }

private:
  FunctionOfPoint f;
  std::size_t dimension;
};

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
  return as_points(experiment.generate());
}

SobolIndices sobol_indices(const FunctionOfPoint& f, const std::size_t dimension, const std::size_t n,
                           const std::uint64_t seed)
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

struct Surrogate::Kriging
{
  OT::KrigingResult result;
  OT::Function mean;
};

Surrogate::Surrogate(const std::vector<UnitPoint>& points, const std::vector<double>& values,
                     const std::vector<double>& noise)
{
  const std::size_t dimension = points.front().size();
  OT::Sample inputs(points.size(), dimension);
  OT::Sample outputs(points.size(), 1);
  OT::Point variances(points.size());
  double mean_value = 0.0;
  for (const double value : values)
    mean_value += value / double(values.size());
  double spread = 0.0;
  for (std::size_t i = 0; i < points.size(); ++i)
    {
      for (std::size_t k = 0; k < dimension; ++k)
        inputs(i, k) = points[i][k];
      outputs(i, 0) = values[i];
      // A value without any scatter would leave the matrix of equal points singular.
      constexpr double least_variance = 1e-8;
      variances[i] = std::max(noise[i], least_variance);
      spread += (values[i] - mean_value) * (values[i] - mean_value) / double(points.size());
    }
  OT::Log::Show(OT::Log::ERROR); // it would warn of its own guesses of the lengths
  // The amplitude in closed form holds without noise only.
  OT::ResourceMap::SetAsBool("GeneralLinearModelAlgorithm-UseAnalyticalAmplitudeEstimate", false);
  // Lengths from a fifth of the cube, about the distance of points of a design, to where the trend has taken over.
  constexpr double shortest = 0.2;
  constexpr double longest = 5.0;
  const double amplitude = std::max(std::sqrt(spread), 1e-3);
  OT::MaternModel covariance(OT::Point(dimension, 1.0), OT::Point(1, amplitude), 2.5);
  OT::KrigingAlgorithm algorithm(inputs, outputs, covariance, OT::LinearBasisFactory(dimension).build());
  algorithm.setNoise(variances);
  OT::Point lower(dimension, shortest);
  OT::Point upper(dimension, longest);
  lower.add(1e-3 * amplitude);
  upper.add(2.0 * amplitude);
  algorithm.setOptimizationBounds(OT::Interval(lower, upper));
  algorithm.run();
  const OT::KrigingResult result = algorithm.getResult();
  kriging = std::make_shared<const Kriging>(Kriging{result, result.getMetaModel()});
}

double Surrogate::mean(const UnitPoint& point) const { return kriging->mean(as_point(point))[0]; }

double Surrogate::deviation(const UnitPoint& point) const
{
  return std::sqrt(std::max(0.0, kriging->result.getConditionalMarginalVariance(as_point(point))));
}

std::vector<std::vector<double>> metropolis(const FunctionOfPoint& log_density, const std::vector<double>& lower,
                                            const std::vector<double>& upper, const std::vector<double>& start,
                                            const Eigen::MatrixXd& covariance, const std::size_t n,
                                            const std::uint64_t seed)
{
  const std::size_t dimension = start.size();
  OT::RandomGenerator::SetSeed(seed);
  OT::CovarianceMatrix of_step(dimension);
  for (std::size_t i = 0; i < dimension; ++i)
    for (std::size_t k = 0; k <= i; ++k)
      of_step(i, k) = 2.38 * 2.38 / double(dimension) * covariance(Eigen::Index(i), Eigen::Index(k));
  constexpr std::size_t thinning = 5; // neighbours of a chain are much alike
  OT::RandomWalkMetropolisHastings chain(OT::Function(OpenTurnsFunction(log_density, dimension)),
                                         OT::Interval(as_point(lower), as_point(upper)), as_point(start),
                                         OT::Normal(OT::Point(dimension, 0.0), of_step));
  chain.setBurnIn(thinning * n / 4);
  chain.setThinning(thinning);
  return as_points(chain.getSample(n));
}
} // namespace feldspar::calibration

#include "calibration/surrogate.h"

#include "calibration/open_turns_function.h"

#include <openturns/KrigingAlgorithm.hxx>
#include <openturns/LinearBasisFactory.hxx>
#include <openturns/Log.hxx>
#include <openturns/MaternModel.hxx>
#include <openturns/ResourceMap.hxx>

#include <algorithm>
#include <cmath>

namespace feldspar::calibration
{
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
} // namespace feldspar::calibration

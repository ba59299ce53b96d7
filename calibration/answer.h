#pragma once

#include "calibration/fit.h"
#include "calibration/response_model.h"

#include <cstdint>
#include <string>
#include <vector>

namespace feldspar::calibration
{
/// Measure of how well the tests determine a parameter.
enum class Determination
{
  determined,    ///< its 90 % interval is a quarter of what the bounds allow, or less
  bounded,       ///< three quarters or less
  not_determined ///< more
};

std::string words(Determination verdict);

/// A micro-parameter after the tests.
struct ParameterAnswer
{
  std::string name; ///< in files
  std::string title;
  std::string unit;
  double unit_size;
  double best; ///< in the input that is written [SI], as all below
  double median;
  double lower_90; ///< 5th and 95th percentile
  double upper_90;
  std::optional<Bounds> bounds; ///< of an unknown that has some
  double share_of_bounds;       ///< of the 90 % interval, of what 90 % of the unconstrained parameter would take
  Determination verdict;
  std::string helpful_test; ///< the response without a target that would tell most of it; empty: none does
  std::string sentence;
};

/// A response in the light of the targets.
struct PredictedResponse
{
  std::size_t response;
  double median; ///< [SI]
  double lower_90;
  double upper_90;
};

/// The posterior distribution.
struct Posterior
{
  std::vector<Place> samples;
  std::vector<ParameterAnswer> parameters;
  std::vector<PredictedResponse> predictions; ///< of the rock's mean; all responses the model knows
};

/// The posterior of micro-parameters. Targets have the deviation of the rock's mean, the scatter of packings, the error
/// of the surrogates; evenly spread between the bounds before. `freedom`: which scales are unknown.
Posterior posterior(const ResponseModel& model, const std::vector<Target>& targets, const FitFreedom& freedom,
                    const Place& best, std::size_t n_samples, std::uint64_t seed);

/// The value below which a share of the values lies, between two of them in proportion. At least one value.
double quantile(std::vector<double> values, double share);
} // namespace feldspar::calibration

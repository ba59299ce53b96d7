#pragma once

#include "calibration/fit.h"
#include "calibration/response_model.h"

#include <cstdint>
#include <functional>
#include <optional>
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
  std::function<double(const MicroParameters&)> value; ///< [SI]
  std::optional<Bounds> bounds = {};                   ///< of an unknown that has some
  bool logarithmic = true;                             ///< spread evenly over its logarithm
  double best = 0.0;                                   ///< in the input that is written [SI], as all below
  double median = 0.0;
  double lower_90 = 0.0; ///< 5th and 95th percentile
  double upper_90 = 0.0;
  double share_of_bounds = 0.0; ///< of the 90 % interval, of what 90 % of the unconstrained parameter would take
  Determination verdict = Determination::not_determined;
  std::string helpful_test = {}; ///< the response without a target that would tell most of it; empty: none does
  std::string sentence = {};

  std::string si_unit() const;
};

/// The parameters that an answer reports, before the tests: the scales that are unknown, the unknowns and, where it follows from
/// them, the cohesion.
std::vector<ParameterAnswer> reported_parameters(const std::vector<Unknown>& unknowns, bool modulus, bool strength);

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

#pragma once

#include "calibration/parameters.h"
#include "laboratory/kinds.h"
#include "results/folder/reference.h"
#include "results/runs/run.h"

#include <cmath>
#include <functional>
#include <optional>
#include <string>
#include <vector>

/// The figures that tests of a specimen give, and those of them that a laboratory measured.
namespace feldspar::calibration
{
/// A figure of a specimen.
struct Response
{
  std::string name;  ///< in files: uniaxial_compressive_strength
  std::string title; ///< in tables
  ShownIn shown;     ///< in tables, and the unit of the reference
  std::string reference_key;
  ResponseScale scale;
  /// SI, by the tests of one specimen; none where they do not give it.
  std::function<std::optional<double>(const std::vector<FinishedTest>&)> value;
  /// Largest value in the design from which the model learns; above it, cracks opened before the state that the figure
  /// is to measure.
  std::optional<double> largest_in_design = std::nullopt;

  /// The scatter of a response is a share of it: responses are compared by logarithms. Poisson's ratio, which may be 0, is
  /// not.
  double in_model(double si_value) const { return scale == ResponseScale::none ? si_value : std::log(si_value); }
  double in_si(double model_value) const { return scale == ResponseScale::none ? model_value : std::exp(model_value); }
  /// A small share of a value is this times the share in the model.
  double per_share(double si_value) const { return scale == ResponseScale::none ? std::abs(si_value) : 1.0; }
};

/// All that a programme gives, in its order.
std::vector<Response> responses(const std::vector<TestCase>& programme, const CalibrationParameters& wanted);

/// The responses of one specimen from its tests; none where one could not be had.
std::vector<std::optional<double>> values_of(const std::vector<Response>& responses,
                                             const std::vector<FinishedTest>& of_specimen);

/// A response that is to come out as the laboratory has it.
struct Target
{
  std::size_t response; ///< its number
  double value;         ///< [SI]
  double deviation;     ///< standard deviation of the rock's mean about it [SI]
  std::string source;   ///< of the deviation, in words
};

/// Targets by the names wanted, or all that the reference has. Throws InputError for a name that the reference lacks or
/// no test of the programme gives, and where there is none at all.
std::vector<Target> targets(const std::vector<Response>& responses, const Reference& reference,
                            const CalibrationParameters& wanted);
} // namespace feldspar::calibration

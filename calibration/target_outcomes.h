#pragma once

#include "calibration/fit.h"
#include "results/statistics.h"

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

/// Targets beside the tests of a place, and the decisions that a calibration takes by them.
namespace feldspar::calibration
{
/// A target and the tests of a place.
struct TargetOutcome
{
  Target target;
  std::optional<Statistics> reached; ///< over packings that no choice was made by [SI]; else by the model
  double predicted;                  ///< [SI]

  double value() const { return reached ? reached->mean : predicted; }
  double deviation() const { return value() / target.value - 1.0; }
};

/// The outcomes by tests of that place.
std::vector<TargetOutcome> outcomes_of(const std::vector<TestedPoint>& points, const std::vector<Target>& targets,
                                       const ResponseModel& model, const Place& place);

/// The outcomes of a fit that no specimen has tested.
std::vector<TargetOutcome> predicted_outcomes(const std::vector<Target>& targets, const Fit& fit);

/// Within the tolerance, or no further off than two standard errors. A target that no specimen gave is not met.
bool is_met(const TargetOutcome& outcome, double tolerance);
bool all_met(const std::vector<TargetOutcome>& outcomes, double tolerance);

/// Within half of the tolerance, which leaves room for fresh packings, or within a standard error: what the packings of a
/// step scatter cannot be mended by another step.
bool is_nearly_met(const TargetOutcome& outcome, double tolerance);

/// As many packings as bring all standard errors below half of the tolerance, by the scatter seen.
std::size_t packings_needed(const std::vector<TargetOutcome>& outcomes, double tolerance);

/// Whether a target stays further off than the fit's surrogates, the packings of the design and the rock's own deviation
/// can explain.
bool is_out_of_reach(const Fit& fit, const std::vector<Target>& targets, const ResponseModel& model, double tolerance,
                     std::size_t n_packings);

/// A sentence on targets that contradict each other: what comes nearest.
std::string nearest_in_words(const std::vector<TargetOutcome>& outcomes, const ResponseModel& model);

/// A sentence on targets that were tested.
std::string statement_of(const std::vector<TargetOutcome>& outcomes, const ResponseModel& model, double tolerance,
                         std::size_t n_steps);
} // namespace feldspar::calibration

#pragma once

#include "calibration/fit.h"
#include "results/statistics.h"
#include "results/target_verdict.h"

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
  bool is_out_of_reach = false;      ///< by the prediction of what no specimen has tested

  double value() const { return reached ? reached->mean : predicted; }
  double deviation() const { return value() / target.value - 1.0; }
};

/// The outcomes by tests of that place.
std::vector<TargetOutcome> outcomes_of(const std::vector<TestedPoint>& points, const std::vector<Target>& targets,
                                       const ResponseModel& model, const Place& place);

/// The outcomes of a fit that no specimen has tested, whose design had so many packings. A target is out of reach if it stays
/// further off than the fit's surrogates, the packings of the design and the rock's own deviation can explain.
std::vector<TargetOutcome> predicted_outcomes(const std::vector<Target>& targets, const Fit& fit,
                                              const ResponseModel& model, double tolerance, std::size_t n_packings);

/// The verdict on a target by its tests: not decided where they did not give it, missed where it is predicted out of
/// reach.
TargetVerdict verdict_on(const TargetOutcome& outcome, double tolerance);
TargetVerdict verdict_on(const std::vector<TargetOutcome>& outcomes, double tolerance);

/// The mean of the tests as a share of the target; without tests that of the prediction, of no packing.
TargetMean mean_of(const TargetOutcome& outcome, const std::string& title);

/// Within half of the tolerance, which leaves room for fresh packings, or within a standard error: what the packings of a
/// step scatter cannot be mended by another step.
bool is_nearly_met(const TargetOutcome& outcome, double tolerance);

/// The half-width of the 95 % intervals that packings of an answer are to reach: half of the tolerance, so that the other
/// half is left for the deviation itself.
constexpr double wanted_half_width(const double tolerance) { return 0.5 * tolerance; }

/// Number of packings that bring the 95 % intervals of all means to the wanted half-width, by the scatter seen, and
/// `most` at most; `most` where a figure came from fewer than two packings.
std::size_t packings_needed(const std::vector<TargetOutcome>& outcomes, double tolerance, std::size_t most);

/// Returns whether another answer is worth its packings: a target is missed, or all intervals are narrow enough to lie
/// within the tolerance, and one does not.
bool is_worth_another_round(const std::vector<TargetOutcome>& outcomes, double tolerance);

/// A sentence on targets that contradict each other: what comes nearest.
std::string nearest_in_words(const std::vector<TargetOutcome>& outcomes, const ResponseModel& model);

/// A sentence on targets that were tested.
std::string statement_of(const std::vector<TargetOutcome>& outcomes, const ResponseModel& model, double tolerance);
} // namespace feldspar::calibration

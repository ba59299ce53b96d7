#pragma once

#include "calibration/answer.h"
#include "calibration/response_model.h"
#include "calibration/target_outcomes.h"
#include "results/runs/run.h"

#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <vector>

/// The files of a calibration in its folder, beside the tests of its answer.
namespace feldspar::calibration
{
/// Files of a calibration that more than one place names.
namespace calibration_file
{
inline constexpr const char* answer = "calibration.json";
inline constexpr const char* design = "design.csv";
inline constexpr const char* posterior = "posterior.csv";
inline constexpr const char* best = "best.prm";
inline constexpr const char* nearest = "nearest.prm"; ///< where a target was missed
} // namespace calibration_file

struct CalibrationOutcome
{
  std::string rock;
  std::string statement; ///< in a sentence
  TargetVerdict verdict = TargetVerdict::not_decided;
  double tolerance = 0.0;
  std::vector<TargetOutcome> targets;
  Posterior posterior;
  std::map<std::string, SobolIndices> sensitivities;     ///< by response, over the unknowns
  std::map<std::string, double> scale_effects;           ///< relative, of half as much strain again
  std::optional<double> modulus_of_specimens_over_cells; ///< initial Young's modulus, mean of the design
  std::size_t n_steps = 0;
  MicroParameters best{};
};

/// Writes calibration.json, design.csv and, where there are samples, posterior.csv.
void write_calibration(const Provenance& made_by, const CalibrationOutcome& outcome, const ResponseModel& model,
                       const std::vector<TestedPoint>& tested, const std::filesystem::path& folder);

/// Writes design.csv alone.
void write_design(const ResponseModel& model, const std::vector<TestedPoint>& tested,
                  const std::filesystem::path& folder);

/// For a terminal: targets, then parameters, then a sentence each.
std::string as_text(const CalibrationOutcome& outcome, const ResponseModel& model);
} // namespace feldspar::calibration

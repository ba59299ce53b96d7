#pragma once

#include "results/runs/run.h"
#include "results/target_verdict.h"

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

namespace feldspar
{
/// Figures of the uniaxial test that a laboratory takes as Young's modulus and Poisson's ratio, in the words of section
/// Calibration of the input.
struct ElasticFigures
{
  std::string youngs_modulus = "tangent"; ///< or initial, or secant
  std::string poissons_ratio = "secant";  ///< or initial
};

/// A calibration as its folder has it and a report shows it; SI.
struct CalibrationRecord
{
  struct TargetRow
  {
    std::string name, title, unit;
    double target, target_deviation, reached;
    std::optional<double> standard_error;
    double deviation;
    double n_packings; ///< 0: `reached` is the prediction
    TargetVerdict verdict;
  };

  struct ParameterRow
  {
    std::string name, title, unit;
    double best;
    std::optional<double> median, lower_90, upper_90; ///< of the posterior, if there is one
    std::string verdict, sentence;                    ///< empty without one
  };

  struct PredictionRow
  {
    std::string name, title, unit;
    double median, lower_90, upper_90;
  };

  struct Sensitivity
  {
    std::string response, parameter;
    double first_order, total;
  };

  std::string rock;
  std::string statement;
  TargetVerdict verdict = TargetVerdict::not_decided; ///< on all targets
  Provenance made_by;
  ElasticFigures elastic; ///< of its reference
  double tolerance = 0.0;
  std::vector<TargetRow> targets;
  std::vector<ParameterRow> parameters;
  std::vector<PredictionRow> predictions;
  std::vector<Sensitivity> sensitivities;
  std::vector<std::string> sampled;         ///< names of the columns of posterior.csv, which end in their SI units
  std::vector<std::vector<double>> samples; ///< [column][sample]
};

/// Reads calibration.json of a folder, and posterior.csv where its parameters have a posterior; none where there is no
/// calibration. A file of before there were verdicts gets them, and its statement, by its own means and standard errors.
/// Throws InputError.
std::optional<CalibrationRecord> read_calibration(const std::filesystem::path& folder);
} // namespace feldspar

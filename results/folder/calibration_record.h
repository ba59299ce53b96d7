#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

namespace feldspar
{
/// A calibration as its folder has it and a report shows it; SI.
struct CalibrationRecord
{
  struct TargetRow
  {
    std::string name, title, unit;
    double target, target_deviation, reached;
    std::optional<double> standard_error;
    double deviation;
    double n_packings;
  };

  struct ParameterRow
  {
    std::string name, title, unit;
    double best, median, lower_90, upper_90;
    std::string verdict, sentence;
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

  std::string statement;
  double tolerance = 0.0;
  std::vector<TargetRow> targets;
  std::vector<ParameterRow> parameters;
  std::vector<PredictionRow> predictions;
  std::vector<Sensitivity> sensitivities;
  std::vector<std::string> sampled;         ///< names of the columns of posterior.csv, which end in their SI units
  std::vector<std::vector<double>> samples; ///< [column][sample]
};

/// Reads calibration.json and posterior.csv of a folder; none where there is no calibration. Throws InputError.
std::optional<CalibrationRecord> read_calibration(const std::filesystem::path& folder);
} // namespace feldspar

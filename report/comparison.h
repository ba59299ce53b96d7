#pragma once

#include "report/run.h"

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

namespace feldspar
{
/// A figure of the rock or of another model, with its range where that is known.
struct ReferenceValue
{
  double mean;
  std::optional<double> low;
  std::optional<double> high;
};

/// One property of the rock: ours beside the references.
struct ComparisonRow
{
  std::string property;
  std::string unit;
  int decimals;
  std::optional<double> mean; ///< over the seeds
  std::optional<double> standard_deviation;
  std::optional<ReferenceValue> model; ///< of the paper
  std::optional<ReferenceValue> experiment;
};

/// Sets results beside a reference file (JSON: rock, experiment, paper_model; see examples/beishan-granite/
/// reference.json). Without a file the reference columns stay empty. Throws InputError for a file that is none.
std::vector<ComparisonRow> compare(const std::vector<FinishedTest>& tests,
                                   const std::optional<std::filesystem::path>& reference_file);

/// For a terminal.
std::string as_text(const std::vector<ComparisonRow>& rows);
} // namespace feldspar

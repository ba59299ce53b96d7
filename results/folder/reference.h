#pragma once

#include "results/fits/fit.h"

#include <filesystem>
#include <map>
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

/// A Hoek-Brown envelope as another source prints it.
struct PrintedEnvelope
{
  double sigma_ci; ///< [Pa]
  double m;
  double s;
  double a;

  /// NaN below the cut-off.
  double sigma_1(double sigma_3) const;
};

/// One column of the reference file.
struct ReferenceSource
{
  std::string label;
  std::map<std::string, ReferenceValue> values; ///< by their names in the file, which end in their units
  std::optional<PrintedEnvelope> envelope;

  /// In units of `scale`; none if it is not there.
  std::optional<ReferenceValue> find(const std::string& key, double scale = 1.0) const;
  /// Its strengths under confinement, `strength_at_5_MPa` and so on, by rising pressure [Pa].
  std::vector<EnvelopePoint> strengths() const;
};

/// What results are set beside (JSON; see examples/beishan-granite/reference.json and docs/report.md).
struct Reference
{
  std::string rock;
  std::vector<std::string> citations;
  ReferenceSource experiment;
  ReferenceSource model; ///< of a paper
};

/// Throws InputError, which names the file, for a file that is none.
Reference read_reference(const std::filesystem::path& file);
} // namespace feldspar

#pragma once

#include "laboratory/kinds.h"
#include "results/fits/strength_envelopes.h"

#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <vector>

namespace feldspar
{
/// A figure of the rock or of another model, as far as it is known: a mean, a range, or both.
struct ReferenceValue
{
  std::optional<double> mean;
  /// The range in which a value counts as the rock's: that of the tests, or, where only their standard deviation is given,
  /// that in which 95 % of further tests would lie, mean ± t_{0.975, n - 1} s sqrt(1 + 1/n) (1.96 s for an unknown n).
  std::optional<double> low;
  std::optional<double> high;
  std::optional<double> standard_deviation = std::nullopt; ///< of the tests
  std::optional<unsigned int> n = std::nullopt;            ///< tests

  /// The mean, or the middle of the range.
  double middle() const;
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

/// A Mohr-Coulomb envelope as another source prints it.
struct PrintedLine
{
  double friction_angle; ///< [rad]
  double cohesion;       ///< [Pa]

  double sigma_1(double sigma_3) const;
};

/// A test under three different stresses, compression positive.
struct TrueTriaxialTest
{
  double sigma_3; ///< [Pa]
  double sigma_2; ///< [Pa]
  double sigma_1; ///< [Pa]
};

/// The rock mass that a source wants constants of.
struct RockMass
{
  double strength_index; ///< GSI
  double disturbance;    ///< D, 0 to 1
};

/// One column of the reference file.
struct ReferenceSource
{
  std::string label;
  std::map<std::string, ReferenceValue> values; ///< by their names in the file, which end in their units
  std::optional<PrintedEnvelope> envelope;
  std::vector<EnvelopePoint> triaxial; ///< single tests, also unconfined ones and those with a negative sigma_3
  std::vector<TrueTriaxialTest> true_triaxial;
  std::optional<RockMass> rock_mass;
  StrengthEnvelopes fitted; ///< to its strengths

  /// Value of a key in units of `scale`; none if it is not there.
  std::optional<ReferenceValue> find(const std::string& key, double scale = 1.0) const;
  /// Strengths of the source at a sigma_3 other than 0 by rising pressure: the single tests, and `strength_at_5_MPa` and so on
  /// where there are none [Pa].
  std::vector<EnvelopePoint> strengths() const;
  /// Line by the friction angle and cohesion of the source; none without both.
  std::optional<PrintedLine> line() const;
};

/// The rock or model to compare results with (JSON; see examples/beishan-granite/reference.json and docs/report.md).
struct Reference
{
  std::string rock;
  std::vector<std::string> citations;
  ReferenceSource experiment;
  ReferenceSource model; ///< of a paper
};

/// Throws InputError, which names file and key, for what is missing, no JSON, unknown, contradictory or beyond what a rock
/// can have, which a number in another unit mostly is. `kinds`: the laboratory tests that there are; the strengths of those that
/// give no point of an envelope are `KIND_strength_MPa`, under a pressure `KIND_5_MPa_strength_MPa`.
Reference read_reference(const std::filesystem::path& file, const std::vector<TestKind>& kinds);
} // namespace feldspar

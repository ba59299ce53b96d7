#pragma once

#include "laboratory/curve.h"

#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace feldspar
{
/// A column of the curve.
struct Channel
{
  double CurveSample::*value;
  std::string_view name;                         ///< on axes
  std::string_view strain_name = "axial strain"; ///< of CurveSample::axial_strain, on axes
};

inline constexpr Channel axial_stress{&CurveSample::axial_stress, "axial stress"};

/// Rule by which one maximum of the measured stress is the strength.
enum class PeakRule
{
  highest,
  first_before_a_fall ///< the halves of a split disc may carry more than the whole one did
};

/// The point that the strength of a test is to an envelope. Reports show tests in this order.
enum class EnvelopeRole
{
  tension,          ///< the uniaxial tensile strength
  compression,      ///< σ_1 at σ_2 = σ_3
  indirect_tension, ///< stands in where no test gives the uniaxial tensile strength
  none
};

/// The properties of a kind of laboratory test, except its set-up on grains; each kind is one
/// constant in dem/lab/protocols/. A property that a kind does not name is one that it does not have.
struct TestKind
{
  std::string_view name = {};     ///< in input and result files: direct_tension
  std::string_view title = {};    ///< in headings: Direct tension
  std::string_view strength = {}; ///< in rows of tables: tensile strength
  double sign = 0.0; ///< +1 pulls, -1 presses: turns tension-positive figures into those of the laboratory curve
  Channel channel = axial_stress; ///< whose peak is the strength
  PeakRule peak_rule = PeakRule::highest;
  EnvelopeRole envelope_role = EnvelopeRole::none;
  bool has_uniform_stress = false; ///< so that its curve gives elastic constants
  bool takes_confining_pressure = false;
  bool pressure_acts_across = false;    ///< the pressure is square to the measured stress and no part of it
  bool runs_on_finite_elements = false; ///< a sample that is pulled or pressed at its ends
  bool follows_stages = false;          ///< of a table, back and forth
  bool has_notch = false;               ///< and so gives a fracture toughness
  bool tilts = false; ///< loaded by its weight alone: the strain of its curve is the tilt of the plate below it [rad]
  int strength_decimals = 1; ///< of the strength in MPa in tables
  int duration_rank = 0;     ///< tests of the higher rank last longer; in one rank those of the higher pressure

  double stress(const CurveSample& row) const { return sign * row.*channel.value; } ///< positive in its sense [Pa]
  double strain(const CurveSample& row) const { return sign * row.axial_strain; }   ///< the same
  /// The stress beyond what the pressure [Pa] alone gives.
  double deviator(const CurveSample& row, const double pressure) const
  {
    return stress(row) - (pressure_acts_across ? 0.0 : pressure);
  }

  friend constexpr bool operator==(const TestKind& a, const TestKind& b) { return a.name == b.name; }
};

/// The order of reports: by what kinds are to the envelope, unconfined before confined, then by name.
bool comes_before(const TestKind& a, const TestKind& b);

/// The role of the kind where σ_2 = σ_3; none where another intermediate stress was held, which no envelope here knows.
EnvelopeRole envelope_role(const TestKind& kind, const std::optional<double>& intermediate_stress);

/// The body of a test.
enum class TestBody
{
  grains,         ///< a specimen that moves in time
  finite_elements ///< a sample in equilibrium at every row; no time, and no grain has a place of its own
};

/// The name used in result files.
std::string name(TestBody body);

/// A test of the programme.
struct TestCase
{
  TestKind kind;
  double confining_pressure = 0.0; ///< compression positive [Pa]
};

/// The name used in result files: the kind, and of a confined test the pressure.
std::string name(const TestCase& test);

/// Test cases: each kind, and each confined one under each of the pressures [Pa], in this order.
std::vector<TestCase> test_cases(const std::vector<TestKind>& kinds, const std::vector<double>& confinements);

/// Returns whether one of the kinds takes a confining pressure.
bool any_takes_confining_pressure(const std::vector<TestKind>& kinds);

/// Names of the kinds, separated by commas.
std::string names(const std::vector<TestKind>& kinds);
} // namespace feldspar

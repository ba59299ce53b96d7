#pragma once

#include "laboratory/curve.h"
#include "laboratory/kinds.h"

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

/// The peak of a curve: its one definition, for tests that run and for finished curves. docs/theory.md §4.5.
namespace feldspar
{
struct TestRecord;

/// Demands on the highest deviator of a test to be its peak.
struct PeakDemands
{
  double least_stress = 0.0;         ///< deviator [Pa]
  double least_time = 0.0;           ///< from where the strain is zero [s]
  double least_fall = 0.05;          ///< fall after the highest deviator, as a share of it
  double end_over_peak_strain = 1.6; ///< strain to which a curve that does not fall stays level, over that at its peak
  bool may_end_rising = false;       ///< where it ends says nothing about the body: a measured curve, a table of stages
  double stress_rate = 0.0;          ///< at which a machine raises its load; 0: not under load control [Pa/s]
};

/// Follows a curve row by row to its peak and beyond; stresses positive in the sense of the test.
class PeakWatch
{
public:
  PeakWatch(const TestKind& kind, double confining_pressure, const PeakDemands& demands);

  /// Takes the next row. By the rule of the first peak no row after a fall is the highest; under load control none after
  /// the body no longer follows the machine.
  void add(const CurveSample& row);

  double highest() const { return highest_deviator; } ///< [Pa]
  std::size_t row() const { return row_of_highest; }  ///< of the highest
  double strain() const { return strain_at_highest; }
  const PeakDemands& demands() const { return wanted; }

  /// Returns whether a body carries the stress; a smaller one may be that of waves where nothing holds it.
  bool is_borne() const { return highest_deviator > 0.0 && highest_deviator >= wanted.least_stress; }
  bool is_too_early() const { return time_of_highest < wanted.least_time; }
  bool has_fallen() const { return is_first_peak || lowest_since < (1.0 - wanted.least_fall) * highest_deviator; }
  /// Returns whether the curve leads above its highest stress: the straight line through the last tenth of its way
  /// would exceed it by 1 %, before the strain has grown by as much as lies between a peak and the end of a test.
  bool is_rising() const;
  /// Returns whether the last row lies where the curve has fallen to, but for a tenth of its fall: a test that ends in
  /// a fall.
  bool is_at_its_lowest() const;
  /// Returns whether the curve has stayed level for as long as a test goes on after its peak: the body yields, or
  /// slides. Stick and slip may move it by 5 % about its mean; the straight line through this stretch rises by no more
  /// than 1 %, or than twice the standard deviation about it.
  bool is_level() const;

  TestKind kind;
  double pressure; ///< compression positive [Pa]

private:
  PeakDemands wanted;
  std::vector<double> strains;   ///< of each row
  std::vector<double> ways;      ///< of the strain up to each row, back and forth
  std::vector<double> deviators; ///< of each row [Pa]
  double highest_deviator = 0.0;
  double lowest_since = 0.0;
  std::size_t row_of_highest = 0;
  double strain_at_highest = 0.0;
  double time_of_highest = 0.0;
  bool has_followed = false;  ///< a machine under load control
  bool lagged_before = false; ///< at the last row
  bool is_first_peak =
    false; ///< by the rule of the first peak, or of a body that slides or runs away: nothing after it counts
};

/// The row of the peak of a finished curve, or the reason why it has none.
struct PeakVerdict
{
  std::optional<std::size_t> row;
  std::string reason;
};

PeakVerdict find_peak(const TestRecord& record);

/// The row of the peak; none if there is none.
std::optional<std::size_t> peak_row(const TestRecord& record);

/// The strength of a sheared plane; under a normal stress that grows as the plane opens, its share of that stress.
double mobilised(const TestRecord& record, const CurveSample& row);
/// Share of its strength that a plane must carry at a row to count as sliding at its strength there.
inline constexpr double share_of_strength = 0.99;

/// Returns whether the stress of a test was rising towards a higher one when it ended, where a table of stages
/// prescribed it.
bool ends_rising(const TestRecord& record);
} // namespace feldspar

#pragma once

#include "laboratory/parameters.h"
#include "laboratory/peak.h"

namespace feldspar
{
/// Follows the curve of a test, row by row, to its end; docs/theory.md §4.5. The first row is where the strain is zero.
/// The state of the rule follows from the rows, so that a resumed test hands it its curve again.
struct StopRule
{
  StopRule(const TestKind& of_test, const double confining_pressure, const PeakDemands& demands)
    : kind(of_test)
    , pressure(confining_pressure)
    , peak(of_test, confining_pressure, demands)
  {
  }

  /// True for a body that swings at first: its test does not end before a bond has broken, except at a wanted strain.
  bool needs_crack = false;

  /// Takes the next row.
  void add(const CurveSample& row) { peak.add(row); }
  /// Returns whether the row that was added last ends the test.
  bool is_met_by(const CurveSample& row, const TestParameters& wanted) const;
  /// Returns whether nothing holds the body: loaded without a wanted strain, it was moved so far without a crack, or
  /// without a stress that a body carries.
  bool bears_nothing(const CurveSample& row, const TestParameters& wanted) const;

  TestKind kind;
  double pressure; ///< compression positive [Pa]
  PeakWatch peak;
};
} // namespace feldspar

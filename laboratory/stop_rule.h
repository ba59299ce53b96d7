#pragma once

#include "laboratory/parameters.h"
#include "laboratory/peak.h"

namespace feldspar
{
/// Follows the curve of a test, row by row, to its end; docs/theory.md §4.5. The first row is where the strain is zero.
/// The state of the rule follows from the rows, so that a resumed test hands it its curve again.
struct StopRule : PeakWatch
{
  using PeakWatch::PeakWatch;

  /// True for a body that swings at first: its test does not end before a bond has broken, except at a wanted strain.
  bool needs_crack = false;

  /// Returns whether the row that was added last ends the test.
  bool is_met_by(const CurveSample& row, const TestParameters& parameters) const;
  /// Returns whether nothing holds the body: loaded without a wanted strain, it was moved so far without a crack, or
  /// without a stress that a body carries.
  bool bears_nothing(const CurveSample& row, const TestParameters& parameters) const;
};
} // namespace feldspar

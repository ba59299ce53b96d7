#pragma once

#include "dem/lab/parameters.h"
#include "results/record.h"

namespace feldspar
{
/// Follows the curve of a test, row by row, to its end; docs/theory.md §4.5.
struct StopRule
{
  explicit StopRule(const TestKind& of_test)
    : kind(of_test)
    , peak(of_test.peak_rule)
  {
  }

  /// Whether this row is the last. confining_pressure in Pa, compression positive.
  bool is_met_by(const CurveSample& row, double confining_pressure, const TestParameters& wanted);

  TestKind kind;
  PeakWatch peak; ///< of the deviator
  double strain_at_peak = 0.0;
};
} // namespace feldspar

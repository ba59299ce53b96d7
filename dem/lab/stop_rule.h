#pragma once

#include "base/byte_archive.h"
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

  /// For a body that swings at first: its test does not end before a bond has broken, except at a wanted strain.
  bool needs_crack = false;

  /// Whether such a body, loaded without a wanted strain, was moved so far without a crack that it bears nothing.
  bool bears_nothing(const CurveSample& row, const TestParameters& wanted) const;

  /// Whether this row is the last. confining_pressure in Pa, compression positive.
  bool is_met_by(const CurveSample& row, double confining_pressure, const TestParameters& wanted);

  /// Into or out of a checkpoint.
  template <typename Archive>
  void transfer(Archive& archive)
  {
    archive.value("peak_deviator", peak.highest);
    transfer_flag(archive, "fallen", peak.fallen);
    archive.value("strain_at_peak", strain_at_peak);
  }

  TestKind kind;
  PeakWatch peak; ///< of the deviator
  double strain_at_peak = 0.0;
};
} // namespace feldspar

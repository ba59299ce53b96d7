#pragma once

#include "results/evaluation.h"
#include "results/fits/fit.h"
#include "results/runs/series.h"

#include <vector>

namespace feldspar
{
/// The stress that a specimen goes on to carry after its peak [Pa], positive in the sense of the test: the mean over the
/// last third of the strain beyond the peak. None, with the reason, where the deviator there is not below 95 % of the
/// peak's, or still changes: its means over both halves of that third differ by more than a tenth of the peak deviator.
Figure residual_strength(const TestRecord& record);

/// Residual strengths of the compression tests under one confinement.
struct ResidualPoint
{
  double sigma_3;
  double sigma_1;   ///< mean over the seeds [Pa]
  double deviation; ///< standard deviation; 0 of one
};

/// The residual strengths of a series, by confinement, where at least half of the tests have one.
std::vector<ResidualPoint> residual_points(const Series& series);
} // namespace feldspar

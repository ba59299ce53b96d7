#pragma once

#include "results/fits/fit.h"
#include "results/runs/run.h"

#include <cstdint>
#include <vector>

namespace feldspar
{
/// τ = c + σ_n tan φ through the peaks of shear tests.
struct ShearLine
{
  double cohesion;       ///< c [Pa]
  double friction_angle; ///< φ [rad]
  double r_squared;
  std::uint64_t n; ///< tests
};

/// The line by least squares through the tests whose pressure acts across the measured stress; others are passed over. Every test counts
/// once; normal stresses of two sizes or more are needed.
FitOrReason<ShearLine> fit_shear_line(const std::vector<const FinishedTest*>& tests);
} // namespace feldspar

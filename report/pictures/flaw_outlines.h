#pragma once

#include "results/run.h"

#include <string>

namespace feldspar
{
/// Flaws of a specimen for gnuplot. Nothing of an intact one.
struct FlawOutlines
{
  std::string data;  ///< blocks of data [mm]
  std::string plots; ///< parts of a plot command, over the grains and under the cracks; each begins with a comma
};

/// As they were before the test: open ones with a rim, closed ones as lines. owner: whose data it is in a script of several
/// tests.
FlawOutlines flaw_outlines(const FinishedTest& test, const std::string& owner);
} // namespace feldspar

#pragma once

#include "results/runs/run.h"

#include <array>
#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

/// The marks on a map of cracks, beside the cracks.
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

/// A crack of a joint among the first that broke.
struct NumberedCrack
{
  std::uint64_t joint;
  std::size_t number;          ///< from 1, in time; joints that broke in one step have the same
  std::array<double, 2> place; ///< of the number: beside its crack and away from the others [m]
};

/// The paper that a map has for its marks [m].
struct MapPaper
{
  std::array<double, 2> low;
  std::array<double, 2> high;
  double letter; ///< the height of one
};

/// The first ten joints that broke. Cracks in the order in which they broke; the vertical axis of the picture.
std::vector<NumberedCrack> number_first_cracks(const std::vector<Crack>& cracks, std::size_t axis,
                                               const MapPaper& paper);
} // namespace feldspar

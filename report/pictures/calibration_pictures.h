#pragma once

#include "report/pictures/gnuplot.h"
#include "results/folder/calibration_record.h"

#include <string>
#include <vector>

namespace feldspar
{
/// An SI value in the unit of tables: GPa, MPa, deg.
struct ShownUnit
{
  std::string name;
  double size;
};

/// The unit for figures of this size; `Pa`, `rad` and `1` are known.
ShownUnit shown_unit(const std::string& si_unit, double size);

/// Every pair of sampled parameters, with the histogram of each; none without samples.
std::vector<Picture> pair_picture(const CalibrationRecord& record);
} // namespace feldspar

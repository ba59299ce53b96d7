#pragma once

#include "report/pictures/gnuplot.h"
#include "results/runs/run.h"

#include <string>
#include <vector>

/// A sample of finite elements at the end of a test: where it is damaged.
namespace feldspar
{
/// The cells as they are displaced, coloured by the share of their segments that broke, with the mean direction of the
/// cracks and the outline of what has localised, where the fields have them. Of a cylinder the section through its axis.
/// None where there are no fields, or no grains.
std::vector<Picture> sample_picture(const FinishedTest& test, const std::string& title);
} // namespace feldspar

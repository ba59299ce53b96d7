#pragma once

#include "report/pictures/gnuplot.h"
#include "results/runs/test_groups.h"

#include <string>
#include <vector>

namespace feldspar
{
/// Cracks of one test at crack initiation, at the peak and at the end: over its grains, or, of a sample of finite
/// elements, counted at each point. Nothing without grains or points.
std::vector<Picture> crack_map(const FinishedTest& test, const std::string& title);
} // namespace feldspar

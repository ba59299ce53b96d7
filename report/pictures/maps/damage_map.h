#pragma once

#include "report/pictures/gnuplot.h"
#include "results/runs/test_groups.h"

#include <string>
#include <vector>

namespace feldspar
{
/// Broken segments at each point of a sample of finite elements, at crack initiation, at the peak and at the end.
std::vector<Picture> damage_map(const FinishedTest& test, const std::string& title);
} // namespace feldspar

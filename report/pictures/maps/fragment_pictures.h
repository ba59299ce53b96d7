#pragma once

#include "report/pictures/gnuplot.h"
#include "results/runs/series.h"
#include "results/runs/test_groups.h"

#include <cstddef>
#include <string>
#include <vector>

namespace feldspar
{
/// Grains of one test at its end, coloured by the size of the fragment they belong to.
std::vector<Picture> fragment_map(const FinishedTest& test, const std::string& title);

/// Share of the volume in fragments smaller than a size, a line for each of the tests shown; in the colour of the series,
/// which is this one of all.
std::vector<Picture> fragment_size_picture(const Series& series, std::size_t which);
} // namespace feldspar

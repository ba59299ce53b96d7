#pragma once

#include "report/pictures/gnuplot.h"
#include "results/runs/series.h"

#include <string>
#include <vector>

namespace feldspar
{
/// Directions of the crack normals of a series, weighted by crack length, one rose for each of the tests shown.
std::vector<Picture> rose_picture(const Series& series);
} // namespace feldspar

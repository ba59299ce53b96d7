#pragma once

#include "report/pictures/gnuplot.h"
#include "results/series.h"
#include "results/test_groups.h"

#include <string>
#include <vector>

namespace feldspar
{
/// Cracks of one test at crack initiation, at the peak and at the end: over its grains, or, of a sample of finite
/// elements, counted at each point. Nothing without grains or points.
std::vector<Picture> crack_map(const FinishedTest& test, const std::string& title);

/// Grains of one test at its end, coloured by the size of the fragment they belong to.
std::vector<Picture> fragment_map(const FinishedTest& test, const std::string& title);

/// Directions of the crack normals of a series, weighted by crack length, one rose for each of the tests shown.
std::vector<Picture> rose_picture(const Series& series);

/// Share of the volume in fragments smaller than a size, a line for each of the tests shown; in the colour of the series,
/// which is this one of all.
std::vector<Picture> fragment_size_picture(const Series& series, std::size_t which);
} // namespace feldspar

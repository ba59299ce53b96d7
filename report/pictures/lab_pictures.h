#pragma once

#include "report/pictures/gnuplot.h"
#include "results/runs/series.h"

#include <vector>

namespace feldspar
{
/// The stress–strain curve and the crack maps of every test.
std::vector<Picture> single_test_pictures(const Series& series);

/// Curves above, crack maps below, of the first specimen; of the confinements the lowest and the highest.
std::vector<Picture> overview_picture(const Series& series);
} // namespace feldspar

#pragma once

#include "report/pictures/gnuplot.h"
#include "results/runs/series.h"

#include <vector>

namespace feldspar
{
/// Of each entry that takes two numbers or more in the tests of all series: each result over it, mean and standard deviation
/// over the seeds, a line for each test of the programme. Where other entries take several values too, each of their
/// combinations has lines of its own; entries that go along with the number have none. Where no two tests differ in one entry
/// alone, as in a table of samples, points without lines. More than six lines are shown by the kind of test, and thinned out.
std::vector<Picture> study_pictures(const std::vector<Series>& all);
} // namespace feldspar

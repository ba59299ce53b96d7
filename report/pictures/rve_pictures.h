#pragma once

#include "report/pictures/gnuplot.h"
#include "results/runs/run.h"

#include <string>
#include <vector>

/// The grains of a few RVEs of a sample of finite elements at the end of a test.
namespace feldspar
{
/// The grains of the test's RVEs with their cracks; none where there are none.
std::vector<Picture> rve_picture(const FinishedTest& test, const std::string& title);

/// By which an RVE is named here and in the picture of its sample: A, B, …
std::string letter_of_rve(std::size_t k);

/// Share of broken segments.
double broken_share(const PointRve& rve);

/// Where an RVE stands, in words: (12.3, 45.6) mm.
std::string standing_of(const PointRve& rve, const SampleFields& fields);
} // namespace feldspar

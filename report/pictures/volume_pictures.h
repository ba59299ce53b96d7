#pragma once

#include "report/pictures/gnuplot.h"
#include "results/run.h"

#include <string>
#include <vector>

/// The grains of a few volumes of a sample of finite elements at the end of a test.
namespace feldspar
{
/// The grains of the test's volumes with their cracks; none where there are none.
std::vector<Picture> volume_picture(const FinishedTest& test, const std::string& title);

/// By which a volume is named here and in the picture of its sample: A, B, …
std::string letter_of_volume(std::size_t k);

/// Share of broken segments.
double broken_share(const PointVolume& volume);

/// Where a volume stands, in words: (12.3, 45.6) mm.
std::string standing_of(const PointVolume& volume, const SampleFields& fields);
} // namespace feldspar

#pragma once

#include "report/pictures/gnuplot.h"
#include "results/run.h"

#include <string>
#include <vector>

/// A sample of finite elements at the end of a test: where it is damaged, and the grains of a few of its volumes.
namespace feldspar
{
/// The cells as they are displaced, coloured by the share of their segments that broke, with the mean direction of the
/// cracks and the outline of what has localised, where the fields have them. Of a cylinder the section through its axis.
/// None where there are no fields, or no grains.
std::vector<Picture> sample_picture(const FinishedTest& test, const std::string& title);

/// The grains of the test's volumes with their cracks; none where there are none.
std::vector<Picture> volume_picture(const FinishedTest& test, const std::string& title);

/// By which a volume is named in both: A, B, …
std::string letter_of_volume(std::size_t k);

/// Share of broken segments.
double broken_share(const PointVolume& volume);

/// Where a volume stands, in words: (12.3, 45.6) mm.
std::string standing_of(const PointVolume& volume, const SampleFields& fields);
} // namespace feldspar

#pragma once

#include "report/pictures/picture.h"
#include "results/runs/run.h"

#include <cstddef>
#include <string>
#include <vector>

/// The representative volumes of a sample of finite elements in words, and in space.
namespace feldspar
{
/// Letter by which an RVE is named in pictures and tables: A, B, …
std::string letter_of_rve(std::size_t k);

/// Share of broken segments.
double broken_share(const PointRve& rve);

/// Position of an RVE in words: (12.3, 45.6) mm.
std::string standing_of(const PointRve& rve, const SampleFields& fields);

/// RVEs in space, each under its heading: the grains behind the mid-plane, with the cracks as discs. Without name and texts.
Picture space_picture_of_rves(const std::vector<PointRve>& rves, const std::vector<std::string>& headings);
} // namespace feldspar

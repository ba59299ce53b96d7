#pragma once

#include "results/runs/run.h"

#include <cstddef>
#include <string>

/// The representative volumes of a sample of finite elements in words.
namespace feldspar
{
/// Letter by which an RVE is named in pictures and tables: A, B, …
std::string letter_of_rve(std::size_t k);

/// Share of broken segments.
double broken_share(const PointRve& rve);

/// Position of an RVE in words: (12.3, 45.6) mm.
std::string standing_of(const PointRve& rve, const SampleFields& fields);
} // namespace feldspar

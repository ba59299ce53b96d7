#pragma once

#include "results/runs/run.h"

#include <array>
#include <string>

namespace feldspar
{
/// The cracks of a test one after the other, with a slider over its curve, for the script of the page: JSON. Grains lie
/// where they were when the loading began, so that a crack stands where it broke. Empty without grains, cracks or a
/// curve, and of what would be too large for a page.
std::string crack_story(const FinishedTest& test);
} // namespace feldspar

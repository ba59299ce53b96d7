#pragma once

#include "results/runs/run.h"

#include <string>

namespace feldspar
{
/// Grains and cracks of a test with its curve, for the viewer of the page (report/page/viewer.js): JSON with arrays in
/// base64. Grains lie where they were when the loading began, so that a crack stands where it broke. Of more than 200 000
/// grains, or 150 000 cracks, every second or third is kept. Empty without grains, cracks or a curve.
std::string specimen_data(const FinishedTest& test);
} // namespace feldspar

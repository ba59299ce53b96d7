#pragma once

#include "runs/samples.h"

#include <vector>

namespace feldspar
{
/// The RVEs of a test that the report shows, as they are at its last step: the point with most broken segments (of
/// equals that of the lowest number), the median of the damaged ones, and of those where nothing broke the middle one by
/// number, or the least damaged. None of a sample without grains.
/// `record` is what the test leaves. Collective; the first rank gets them.
std::vector<PointRve> point_rves(const PlannedSample& planned, const SampleTest& test, const TestRecord& record);
} // namespace feldspar

#pragma once

#include "app/multiscale_run.h"

#include <vector>

namespace feldspar
{
/// The volumes of a test that the report shows, as they are at its last step: the point with most broken segments, the
/// median of the damaged ones and one where nothing broke, or the least damaged. Of equals the lowest number; none of a
/// sample without grains. `record` is what the test leaves. Collective; the first rank gets them.
std::vector<PointVolume> point_volumes(const PlannedSample& planned, const SampleTest& test, const TestRecord& record);
} // namespace feldspar

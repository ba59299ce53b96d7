#pragma once

#include "results/run.h"

#include <filesystem>

namespace feldspar
{
/// Writes grains and cracks along a test for ParaView: NAME.h5 with NAME_grains.xdmf and NAME_cracks.xdmf, time series
/// over the axial strain (in percent, positive in the sense of the test).
void write_fields(const FinishedTest& test, const std::filesystem::path& folder);
} // namespace feldspar

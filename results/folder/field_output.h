#pragma once

#include "results/appearance.h"

#include <filesystem>
#include <string>
#include <vector>

namespace feldspar
{
/// Writes grains and cracks along a test for ParaView: NAME.h5 with NAME_grains.xdmf and NAME_cracks.xdmf, time series
/// over the axial strain (in percent, positive in the sense of the test).
void write_fields(const std::string& name, const TestKind& kind, const std::vector<Crack>& cracks,
                  const TestAppearance& appearance, const std::filesystem::path& folder);
} // namespace feldspar

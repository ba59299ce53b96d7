#pragma once

#include "laboratory/appearance.h"

#include <vector>

namespace feldspar
{
/// Colour of each grain by the mineral grain or clump that it is a part of: 0xRRGGBB. Pale, so that cracks stand out.
/// Groups that are in contact where the test begins have different colours as long as there are enough; grains of no
/// group share one.
std::vector<unsigned int> group_colours(const std::vector<GrainPicture>& grains);
} // namespace feldspar

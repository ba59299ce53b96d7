#pragma once

#include "results/runs/run.h"

namespace feldspar
{
/// A test in space as pictures in the plane show it: the grains and cracks of a slice through the axis, a quarter of the
/// depth thick, seen from the front (x to the right, z up). A test in the plane stays as it is.
FinishedTest plane_view(FinishedTest test);
} // namespace feldspar

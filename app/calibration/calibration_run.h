#pragma once

#include "app/run/run.h"

namespace feldspar::calibration
{
/// A calibration from its first intact cell to the tests of its answer: elastic constants, design, steps, strain scale,
/// fresh packings, posterior. Throws Interrupted, and InputError where targets cannot be reached by the intact rock.
template <int dim>
RunEnd calibrate(const Run& run);
} // namespace feldspar::calibration

#pragma once

#include "results/fits/fit.h"
#include "results/runs/run.h"

#include <optional>
#include <string>
#include <vector>

namespace feldspar
{
/// The strengths of a programme as envelopes are fitted to them: means over the seeds of the tests that are points of
/// compression, and of those of tension (of indirect tension where there are none). Other tests are left out, and tests that
/// are not valid ones of their kind.
/// `variant`: of its tests alone.
StrengthData strength_data(const std::vector<FinishedTest>& tests,
                           const std::optional<std::string>& variant = std::nullopt);
} // namespace feldspar

#pragma once

#include "results/fits/strength_envelopes.h"
#include "results/runs/run.h"

#include <map>
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

/// The envelopes of each rock of a run: of every variant by its label, of a run without variants by an empty one.
/// Variants are different rocks and are not fitted together. Fitted once; log, summary and report take them from here.
using RunEnvelopes = std::map<std::string, StrengthEnvelopes>;

RunEnvelopes fit_each_rock(const std::vector<FinishedTest>& tests);
} // namespace feldspar

#pragma once

#include "results/fits/strength_envelopes.h"
#include "results/runs/run.h"

#include <map>
#include <string>
#include <vector>

namespace feldspar
{
/// The envelopes of each rock of a run: of every variant by its label, of a run without variants by an empty one.
/// Variants are different rocks and are not fitted together. Fitted once; log, summary and report take them from here.
using RunEnvelopes = std::map<std::string, StrengthEnvelopes>;

RunEnvelopes fit_each_rock(const std::vector<FinishedTest>& tests);
} // namespace feldspar

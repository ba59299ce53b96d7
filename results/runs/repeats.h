#pragma once

#include "results/runs/run.h"

#include <string>
#include <vector>

namespace feldspar
{
/// Variants of a study whose results are those of another to ten digits: the entries in which they differ have no effect
/// there. A sentence for each such set of entries; none where every variant has results of its own.
std::vector<std::string> remarks_on_repeats(const std::vector<const FinishedTest*>& tests);
} // namespace feldspar

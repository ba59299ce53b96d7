#pragma once

#include "results/folder/reference.h"
#include "results/runs/run.h"

#include <optional>
#include <string>
#include <vector>

namespace feldspar
{
/// A study for a terminal: a line a variant with the means of its results over the seeds, in columns that are numbered and
/// named above; results that are the same in all variants are named below.
std::string study_as_text(const std::vector<FinishedTest>& tests, const std::optional<Reference>& reference);
} // namespace feldspar

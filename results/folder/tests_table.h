#pragma once

#include "results/runs/run.h"

#include <filesystem>
#include <vector>

namespace feldspar
{
/// All tests of a run as one table, for a data frame: a row a test; columns are its name, kind, seed, each entry that differs
/// between variants, and each result by its name in summary.json. A number has a cell of its own, its unit is in the name of
/// the column; what could not be had is empty. Throws OutputError.
void write_tests(const std::vector<FinishedTest>& tests, const std::filesystem::path& file);
} // namespace feldspar

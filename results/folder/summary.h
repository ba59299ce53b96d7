#pragma once

#include "results/run.h"

#include <filesystem>
#include <vector>

namespace feldspar
{
/// Writes summary.json: provenance, every test's figures in SI units, means over seeds. What could not be had is null,
/// with the reason in a field of the same name and `_reason`.
void write_summary(const Provenance& provenance, const std::vector<FinishedTest>& tests,
                   const std::filesystem::path& file);
} // namespace feldspar

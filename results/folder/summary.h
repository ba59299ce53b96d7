#pragma once

#include "results/fits/run_envelopes.h"
#include "results/runs/run.h"

#include <filesystem>
#include <string>
#include <vector>

namespace feldspar
{
/// A test as an element of `tests` in summary.json.
std::string test_as_json(const FinishedTest& test);

/// Envelopes as `fits` in summary.json.
std::string envelopes_as_text(const StrengthEnvelopes& envelopes);

/// Writes summary.json: provenance, every test's figures in SI units, means over seeds, and the envelopes of a run
/// without variants. A figure that could not be had is null, with the reason in a field of the same name and `_reason`.
void write_summary(const Provenance& provenance, const std::vector<FinishedTest>& tests, const RunEnvelopes& envelopes,
                   const std::filesystem::path& file);
} // namespace feldspar

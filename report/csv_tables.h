#pragma once

#include "report/run.h"

#include <filesystem>
#include <vector>

namespace feldspar
{
/// The curve of a test, a row per sample. Stress and strain are positive in the sense of the test: tension in a tension
/// test, compression in a compression test.
void write_curve(const FinishedTest& test, const std::filesystem::path& file);

/// The cracks of all tests, in the order in which they came.
void write_cracks(const std::vector<FinishedTest>& tests, const std::filesystem::path& file);
} // namespace feldspar

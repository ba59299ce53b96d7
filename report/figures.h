#pragma once

#include "report/run.h"

#include <filesystem>
#include <string>
#include <vector>

namespace feldspar
{
/// What became of the figures.
struct DrawnFigures
{
  std::vector<std::filesystem::path> files;
  std::string problem; ///< why some are missing; empty if none is
};

/// Draws by gnuplot, into a folder that exists: for each test its stress–strain curve (PNG, SVG, PDF) and its crack map
/// at the end (PNG), and one overview of the first specimen (PNG). Without gnuplot says so.
DrawnFigures draw_figures(const std::vector<FinishedTest>& tests, const std::filesystem::path& folder);
} // namespace feldspar

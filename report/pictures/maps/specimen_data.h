#pragma once

#include "results/runs/run.h"

#include <cstddef>
#include <string>
#include <vector>

namespace feldspar
{
/// A test that the viewer shows, under a title.
struct TitledTest
{
  const FinishedTest* test;
  std::string title;
  std::string colour = {}; ///< of its curve; empty: one of the viewer's own
};

/// Largest number of tests that the viewer shows side by side.
inline constexpr std::size_t most_specimens = 4;

/// Content of a picture for paper: the stages of a test with their cracks, or the fragments at its end.
enum class ShownOnPaper
{
  cracks,
  fragments
};

/// Grains, cracks and events of tests with their curves, for the viewer of the page (report/page/specimens.js): JSON with arrays in
/// base64. Grains lie where they were when the loading began, so that a crack stands where it broke. Of more than 200 000
/// grains, or 100 000 cracks, of all tests every second or third is kept, of more than 20 000 events the largest. Tests without
/// grains or a curve are left out; empty without any other.
std::string specimen_data(const std::vector<TitledTest>& tests, ShownOnPaper on_paper = ShownOnPaper::cracks);
} // namespace feldspar

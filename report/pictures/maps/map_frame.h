#pragma once

#include "report/pictures/maps/map_marks.h"
#include "results/runs/test_groups.h"

#include <array>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <string>
#include <utility>
#include <vector>

/// The paper that maps of a specimen or sample are drawn on: their limits, their stages, their set-up for gnuplot.
namespace feldspar
{
/// The axis of the tests: the last one.
std::size_t vertical_axis(const TestRecord& record);

/// "seed 3".
std::string seed_of(const FinishedTest& test);

/// Limits of a map, its margins the same for all stages of a test.
struct MapLimits
{
  std::array<double, 2> low{std::numeric_limits<double>::infinity(), std::numeric_limits<double>::infinity()};
  std::array<double, 2> high{-std::numeric_limits<double>::infinity(), -std::numeric_limits<double>::infinity()};

  double width() const { return high[0] - low[0]; }
  double height() const { return high[1] - low[1]; }

  std::string ranges() const; ///< for gnuplot
};

/// Around all grains as they lay at the start and where they came to. What flew farther than half the specimen's size is
/// left out, for it would make the specimen small.
struct MapFrame
{
  MapLimits frame;
  std::size_t n_outside = 0;

  std::string remark() const; ///< what a caption says of those left out
};

MapFrame map_frame_of(const FinishedTest& test);

/// The part of a script that all maps have; in gnuplot's words.
std::string map_set_up(const MapLimits& frame, const TestRecord& record);

/// Whether panels stand better one below the other.
bool is_long(const MapLimits& frame);

/// Pixels of a panel that is high enough for tics and key.
std::pair<int, int> panel_size(const MapLimits& frame);

/// Where numbers are written on a map.
MapPaper paper_of(const MapLimits& frame);

/// A stage of a test: cracks up to a step.
struct MapStage
{
  std::string title;
  std::uint64_t last_step;
};

/// Crack initiation and peak, where there are any, and the end.
std::vector<MapStage> map_stages(const TestRecord& record);

/// At which stages: "at the peak and at the end".
std::string in_words(const std::vector<MapStage>& all);
} // namespace feldspar

#pragma once

#include "report/chart/chart.h"
#include "results/runs/run.h"
#include "results/runs/test_groups.h"

#include <array>
#include <cstddef>
#include <cstdint>
#include <string>
#include <utility>
#include <vector>

/// Maps of a specimen or sample: their limits, axes and stages; grains, cracks, flaws and numbers on them.
namespace feldspar
{
/// Flaws as they were before the test, in millimetres, over the grains and under the cracks: open ones with a rim, closed
/// ones as lines.
std::vector<ChartSeries> flaw_lines(const FinishedTest& test);

/// Grains in the plane at the end as circles, in millimetres from an origin [m]: those of the largest fragment, or the
/// loose ones.
ChartSeries grain_circles(const std::vector<GrainPicture>& grains, bool loose,
                          const std::array<double, 2>& origin = {});

/// The trace of a crack's face in the plane.
ChartPoint trace_of(const Crack& crack, const std::array<double, 2>& origin = {});

/// The cracks of each kind as traces of this width, with their numbers in the key.
std::vector<ChartSeries> crack_traces(const std::vector<Crack>& cracks, double width,
                                      const std::array<double, 2>& origin = {});

/// A crack of a joint among the first that broke.
struct NumberedCrack
{
  std::uint64_t joint;
  std::size_t number;          ///< from 1, in time; joints that broke in one step have the same
  std::array<double, 2> place; ///< of the number: beside its crack and away from the others [m]
};

/// The paper that a map has for its marks [m].
struct MapPaper
{
  std::array<double, 2> low;
  std::array<double, 2> high;
  double letter; ///< the height of one
};

/// The first ten joints that broke. Cracks in the order in which they broke.
std::vector<NumberedCrack> number_first_cracks(const std::vector<Crack>& cracks, const MapPaper& paper);

/// The axis of the tests: the last one.
std::size_t vertical_axis(const TestRecord& record);

/// "seed 3".
std::string seed_of(const FinishedTest& test);

/// Limits of a map, its margins the same for all stages of a test.
using MapLimits = Limits<2>;

/// Frame around all grains as they lay at the start and where they came to. Grains that flew farther than half the
/// specimen's size are left out, because they would make the specimen small.
struct MapFrame
{
  MapLimits frame;
  std::size_t n_outside = 0;

  std::string remark() const; ///< what a caption says of those left out
};

MapFrame map_frame_of(const FinishedTest& test);

/// A map without anything on it: millimetres, the axis of the test upwards.
Chart empty_map(const MapLimits& frame, const TestRecord& record, const std::string& title = "");

/// Returns whether panels stand better one below the other.
bool is_long(const MapLimits& frame);

/// Pixels of a panel that is high enough for tics and key.
std::pair<int, int> panel_size(const MapLimits& frame);

/// Region of a map in which numbers are written.
MapPaper paper_of(const MapLimits& frame);

/// A stage of a test: cracks up to a step.
struct MapStage
{
  std::string title;
  std::uint64_t last_step;
};

/// Crack initiation and peak, where there are any, and the end.
std::vector<MapStage> map_stages(const TestRecord& record);

/// Stages in words: "at the peak and at the end".
std::string in_words(const std::vector<MapStage>& all);
} // namespace feldspar

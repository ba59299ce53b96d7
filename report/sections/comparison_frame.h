#pragma once

#include "report/page/table.h"
#include "report/sections/findings.h"

#include <optional>
#include <vector>

namespace feldspar
{
/// The series that are compared with the rock, by their numbers. Measured curves have tables of their own beside the model,
/// if there is one.
std::vector<std::size_t> compared_series(const Findings& findings);

/// The cost of a series: means over its specimens.
struct Cost
{
  Statistics grains;
  Statistics time; ///< sum of the times of a specimen's tests, each on one core [s]
};

/// Cost of a series; none without grains.
std::optional<Cost> cost_of(const Series& series);

/// The comparison for a data frame, a row for each property of each source: the series, the experiment and the other model
/// of the reference. The entries that differ between variants have columns of their own.
DataFrame comparison_frame(const Findings& findings);
} // namespace feldspar

#pragma once

#include "report/page/table.h"
#include "report/sections/findings.h"

#include <optional>
#include <vector>

/// The tables of the sections.
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

/// Every property of every series beside the rock, a line each.
Table comparison_table(const Findings& findings);

/// The same with a line for each series, and before them the experiment and the other model of the reference.
Table comparison_of_many(const Findings& findings);

/// The n-th series, of measured curves, beside the model's tests of their kinds and pressures, a table each. What a curve lacks
/// has its reason.
std::vector<Table> measured_tables(const Findings& findings, std::size_t n);

/// Mean strengths of every kind of test.
Table strength_table(const Findings& findings);

/// Figures of the specimens, one a line, for seeds with which a test was made.
Table specimen_table(const Series& series);

/// The stages of tests that follow a loading table, a row each; no rows where there are no such tests.
Table stage_table(const std::vector<FinishedTest>& tests);

/// Acoustic emission of every kind of test in windows of stress up to the peak, and of catalogues of a laboratory; no rows without
/// events.
Table emission_table(const Series& series, const std::vector<EmissionCatalogue>& catalogues);

/// Cracks of every kind of test by where they lie among the minerals; no rows of rocks without minerals.
Table mineral_table(const Series& series);

/// Figures of every test in SI: the page shows those that are read most, the file has all.
Table test_table(const Findings& findings);
} // namespace feldspar

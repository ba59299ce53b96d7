#pragma once

#include "report/page/table.h"
#include "report/sections/findings.h"

namespace feldspar
{
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

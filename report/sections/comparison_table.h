#pragma once

#include "report/page/table.h"
#include "report/sections/findings.h"

namespace feldspar
{
/// Every property of every series beside the rock, a line each.
Table comparison_table(const Findings& findings);

/// The same with a line for each series, and before them the experiment and the other model of the reference.
Table comparison_of_many(const Findings& findings);

/// The n-th series, of measured curves, beside the model's tests of their kinds and pressures, a table each. What a curve lacks
/// has its reason.
std::vector<Table> measured_tables(const Findings& findings, std::size_t n);
} // namespace feldspar

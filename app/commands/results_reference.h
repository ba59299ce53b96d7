#pragma once

namespace feldspar
{
/// Prints docs/results.md: the quantities of tests, the properties that a reference may give and the columns of curves, from the tables that
/// results, comparisons and readers use.
void print_results_reference();
} // namespace feldspar

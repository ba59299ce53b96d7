#pragma once

#include "report/page/table.h"
#include "results/series.h"

#include <string>
#include <vector>

namespace feldspar
{
/// A measure of how far a series can be trusted, over its tests.
struct TrustCheck
{
  std::string measure;
  std::string bound; ///< in words: at most 1 %
  std::string mean;  ///< over the tests
  std::string worst; ///< and of which test
  std::size_t n_tests = 0;
  std::size_t n_out = 0; ///< tests out of the bound
};

/// Energy balance, quasi-static evidence, servo, resolution; nothing for what was measured on rock. The bounds and their
/// reasons are in docs/report.md.
std::vector<TrustCheck> trust_checks(const Series& series);

/// What is out of its bounds, what failed and what is missing, each in a sentence; nothing if all is well.
std::vector<std::string> warnings(const Series& series);

/// How the specimens came out, one a line.
Table specimen_table(const Series& series);
} // namespace feldspar

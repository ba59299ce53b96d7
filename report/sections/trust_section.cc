#include "report/sections/sections.h"

#include "base/append.h"
#include "report/sections/provenance.h"
#include "report/sections/test_tables.h"
#include "results/trust.h"

#include <fmt/format.h>

#include <algorithm>
#include <string>
#include <utility>
#include <vector>

namespace feldspar
{
namespace
{
Table check_table(const Series& series, const std::string& name)
{
  Table table{name, "Checks over all tests", {"measure", "bound", "mean", "worst", "within"}, {}};
  for (const auto& check : trust_checks(series))
    table.rows.push_back({std::string(check.measure.title), check.measure.bound_text(), check.measure.text(check.mean),
                          fmt::format("{} ({})", check.measure.text(check.worst), check.worst_test),
                          check.n_out == 0 ? fmt::format("✓ all {}", check.n_tests)
                                           : fmt::format("✗ {} of {} out", check.n_out, check.n_tests)});
  return table;
}

/// The checks of the n-th series, its specimens, what made it and its input.
std::vector<PageBlock> evidence(const Findings& findings, const std::size_t n)
{
  const Series& series = findings.all[n];
  PageBlock block = findings.heading_of(n);
  if (series.kind == SeriesKind::laboratory_curve)
    {
      block.paragraphs.push_back("Measured on rock; there is nothing of ours to be checked.");
      return {block};
    }
  if (series.kind == SeriesKind::finite_elements)
    block.paragraphs.push_back("Each row of a curve is an equilibrium, found without time: there is no kinetic "
                               "energy, no wave and no servo to be checked.");
  block.tables.push_back(check_table(series, "trust" + findings.ending_of_files(n)));
  if (std::any_of(series.tests.begin(), series.tests.end(),
                  [](const FinishedTest& test) { return test.record.specimen.n_grains > 0; }))
    {
      Table specimens = specimen_table(series);
      specimens.name += findings.ending_of_files(n);
      block.tables.push_back(specimens);
    }
  block.paragraphs.push_back(sentence_of(series.made_by));
  const std::string name = "input" + findings.ending_of_files(n);
  const Series& first = findings.all.front();
  Table input = n == 0 || first.kind == SeriesKind::laboratory_curve
                  ? input_table(series.made_by, name)
                  : input_table(series.made_by, name, first.made_by, first.label);
  if (input.rows.empty())
    {
      block.paragraphs.push_back(fmt::format("Its input is that of {}.", first.label));
      return {block};
    }
  PageBlock folded;
  folded.folded = findings.titled("Input", series);
  folded.tables.push_back(std::move(input));
  return {block, folded};
}
} // namespace

PageSection trust_section(const Findings& findings)
{
  PageSection section{"trust", "Trust", "How far to trust it", {}};
  for (std::size_t n = 0; n < findings.all.size(); ++n)
    append(section.blocks, evidence(findings, n));
  PageBlock tests;
  tests.folded = "Every test";
  tests.tables = {strength_table(findings), test_table(findings, false)};
  section.blocks.push_back(tests);
  return section;
}
} // namespace feldspar

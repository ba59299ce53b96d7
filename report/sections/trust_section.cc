#include "report/sections/sections.h"

#include "base/append.h"
#include "base/contains.h"
#include "report/sections/provenance.h"
#include "report/sections/tables.h"
#include "report/sections/text.h"
#include "results/folder/result_folder.h"
#include "results/runs/trust.h"

#include <fmt/format.h>

#include <algorithm>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace feldspar
{
namespace
{
Table check_table(const Series& series, const std::string& name)
{
  Table table{name, "Checks over all tests", {"measure", "bound", "mean", "worst", "within"}};
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
  if (std::ranges::any_of(series.tests, [](const FinishedTest& test) { return test.record.specimen.n_grains > 0; }))
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
  return {block, {.folded = findings.titled("Input", series), .tables = {std::move(input)}}};
}

/// The worst value of every measure, a row a series.
Table checks_of_many(const Findings& findings)
{
  Table table{"checks", "Checks of every series: the worst value over its tests, ✗ out of the bound", {"series"}};
  std::vector<std::string_view> measures;
  for (const auto& series : findings.all)
    for (const auto& check : trust_checks(series))
      if (!contains(measures, check.measure.name))
        {
          measures.push_back(check.measure.name);
          table.header.push_back(fmt::format("{}, {}", check.measure.title, check.measure.bound_text()));
        }
  for (const auto& series : findings.all)
    {
      std::vector<std::string> row(1 + measures.size(), text::none);
      row.front() = series.label;
      for (const auto& check : trust_checks(series))
        row[1 + std::size_t(std::ranges::find(measures, check.measure.name) - measures.begin())] =
          (check.n_out > 0 ? "✗ " : "") + check.measure.text(check.worst);
      if (series.kind != SeriesKind::laboratory_curve)
        table.rows.push_back(std::move(row));
    }
  return table;
}

/// The same evidence with a row a series; its own tables of each are files.
std::vector<PageBlock> evidence_of_many(const Findings& findings)
{
  PageBlock block{.paragraphs = {fmt::format("Means over the tests, specimens and input of each series are in {}/ "
                                             "(trust_*, specimens_*, input_*).",
                                             result_file::tables)},
                  .tables = {checks_of_many(findings)}};
  const Series& first = findings.all.front();
  Table differences{"inputs",
                    fmt::format("Input where it differs from that of {}", first.label),
                    {"series", "section", "entry", "value", first.label}};
  for (std::size_t n = 0; n < findings.all.size(); ++n)
    {
      for (PageBlock& own : evidence(findings, n))
        append(block.tables_as_files, std::move(own.tables));
      const Series& series = findings.all[n];
      if (n == 0 || series.kind == SeriesKind::laboratory_curve)
        continue;
      if (const std::string sentence = sentence_of(series.made_by); sentence != sentence_of(first.made_by))
        differences.rows.push_back({series.label, "", "", sentence, sentence_of(first.made_by)});
      for (auto& row : input_table(series.made_by, "", first.made_by, first.label).rows)
        {
          row.insert(row.begin(), series.label);
          differences.rows.push_back(std::move(row));
        }
    }
  return {block,
          {.folded = "Input",
           .paragraphs = {sentence_of(first.made_by)},
           .tables = {input_table(first.made_by, "input" + findings.ending_of_files(0)), std::move(differences)}}};
}
} // namespace

PageSection trust_section(const Findings& findings)
{
  PageSection section{"trust", "Trust", "How far to trust it"};
  if (findings.has_many())
    section.blocks = evidence_of_many(findings);
  else
    for (std::size_t n = 0; n < findings.all.size(); ++n)
      append(section.blocks, evidence(findings, n));
  section.blocks.push_back({.folded = "Every test", .tables = {strength_table(findings), test_table(findings)}});
  return section;
}
} // namespace feldspar

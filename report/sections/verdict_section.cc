#include "laboratory/named_entries.h"
#include "report/sections/sections.h"

#include "report/pictures/plot_style.h"
#include "report/sections/tables.h"
#include "report/sections/text.h"
#include "report/sections/verdict.h"
#include "results/folder/result_folder.h"
#include "results/runs/bodies.h"
#include "results/runs/trust.h"

#include <fmt/format.h>

#include <algorithm>
#include <string>

namespace feldspar
{
namespace
{
/// The material of the points, as the input names it.
std::string material_at_points(const Provenance& made_by)
{
  const std::string material = made_by.value_of(input_entries::material);
  if (material.empty())
    return "";
  return material == "grains" ? " with a representative volume of grains at every point"
                              : " of " + material + ", without grains";
}

/// ✗ 2: tensile strength, Young's modulus
std::string count_and_names(const std::vector<std::string>& names, const std::string& mark = "✗")
{
  return names.empty() ? "✓ none" : fmt::format("{} {}: {}", mark, names.size(), fmt::join(names, ", "));
}

/// The measures of the blocks of few series, a row for each series; the table is to be opened.
std::vector<PageBlock> verdict_of_many(const Findings& findings)
{
  Table table{
    "verdicts",
    "Every series: tests made and wanted, properties in and out of the range of experiments or not decided, measures out of "
    "their bounds",
    {"series", "made", "of tests", "properties in range", "properties out of range", "properties not decided",
     "measures out of bounds", "could not be read"}};
  std::size_t n_compared = 0, n_in_every_range = 0, n_not_decided = 0, n_warned = 0, n_models = 0;
  for (std::size_t n = 0; n < findings.all.size(); ++n)
    {
      const Series& series = findings.all[n];
      if (series.kind == SeriesKind::laboratory_curve)
        continue;
      ++n_models;
      std::size_t n_in = 0;
      std::vector<std::string> out, open;
      for (const auto& row : findings.comparisons[n])
        if (const auto found = row.against_range())
          {
            n_in += found == RangeVerdict::within;
            if (found != RangeVerdict::within)
              (found == RangeVerdict::outside ? out : open).push_back(row.property);
          }
      const bool is_compared = n_in > 0 || !out.empty() || !open.empty();
      n_compared += is_compared;
      n_in_every_range += is_compared && out.empty() && open.empty();
      n_not_decided += out.empty() && !open.empty();
      std::vector<std::string> measures_out;
      for (const auto& check : trust_checks(series))
        if (check.n_out > 0)
          measures_out.emplace_back(check.measure.name);
      n_warned += !measures_out.empty();
      const auto n_made =
        std::ranges::count_if(series.tests, [](const FinishedTest& test) { return test.record.failure.empty(); });
      table.rows.push_back({series.label, fmt::format("{}", n_made), fmt::format("{}", series.tests.size()),
                            is_compared ? fmt::format("{}", n_in) : text::none,
                            is_compared ? count_and_names(out) : text::none,
                            is_compared ? count_and_names(open, "?") : text::none, count_and_names(measures_out),
                            fmt::format("{}", fmt::join(series.problems, "; "))});
    }
  PageBlock block;
  block.headline =
    n_compared > 0
      ? fmt::format("{} of {} series lie in every range that experiments give{}.", n_in_every_range, n_compared,
                    n_not_decided > 0 ? fmt::format("; {} are not decided by their specimens", n_not_decided) : "")
      : "Nothing to compare with: " +
          (findings.reference_problem.empty()
             ? std::string("no property was both tested here and given with a range for the rock")
             : findings.reference_problem) +
          ".";
  block.paragraphs.push_back(
    fmt::format("Measures are out of their bounds in {} of {} series; the section Trust has their worst values. The "
                "warnings on each series are in {} of its run (verdict).",
                n_warned, n_models, result_file::summary));
  block.warnings = grouped_warnings(findings.all);
  return {block, {.folded = "Every series", .tables = {std::move(table), comparison_of_many(findings)}}};
}
} // namespace

PageSection verdict_section(const Findings& findings)
{
  PageSection section{"verdict", "Verdict",
                      findings.reference ? "Does the model match the rock?" : "Results and how far to trust them"};
  if (findings.has_many())
    section.blocks = verdict_of_many(findings);
  // A problem that keeps all models from being compared is said once: for one model in its headline, for several below
  // them.
  const auto n_models = std::ranges::count_if(
    findings.all, [](const Series& series) { return series.kind != SeriesKind::laboratory_curve; });
  const bool is_problem_below = !findings.reference_problem.empty() && n_models != 1;
  SharedWarnings shared;
  if (findings.is_study() || findings.has_many())
    shared = {grouped_warnings(findings.all), std::vector<std::vector<std::string>>(findings.all.size())};
  else
    shared = shared_warnings(findings.all);
  for (std::size_t n = 0; n < findings.all.size(); ++n)
    {
      if (findings.has_many() && findings.all[n].kind != SeriesKind::laboratory_curve)
        continue;
      PageBlock block = findings.heading_of(n);
      block.warnings = shared.own[n];
      if (findings.all[n].kind == SeriesKind::laboratory_curve)
        {
          block.subheading = findings.all[n].label;
          block.chip = plot::colour(findings.all[n], n);
          block.paragraphs.push_back("Measured in a laboratory and evaluated as the model's tests are.");
          block.tables = measured_tables(findings, n);
        }
      else
        {
          const Verdict found = verdict(findings.comparisons[n], findings.reference, findings.reference_problem);
          if (findings.all[n].kind == SeriesKind::finite_elements)
            block.paragraphs.push_back(
              fmt::format("Made on a sample of finite elements{}, and evaluated as tests on specimens of grains are.",
                          material_at_points(findings.all[n].made_by)));
          const bool is_compared =
            std::ranges::any_of(found.tiles, [](const Tile& tile) { return !tile.notes.empty(); });
          if (!is_problem_below && is_compared)
            block.headline = found.headline;
          else if (!is_problem_below)
            block.paragraphs.push_back(found.headline);
          block.tiles = found.tiles;
          block.points = found.points;
          if (block.warnings.empty() && shared.of_all.empty())
            block.paragraphs.push_back("Every check of the section Trust is within its bounds.");
        }
      if (!block.headline.empty() || !block.paragraphs.empty() || !block.tiles.empty() || !block.points.empty() ||
          !block.warnings.empty())
        section.blocks.push_back(block);
    }
  if (!findings.has_many() && !shared.of_all.empty())
    section.blocks.push_back({.subheading = "All models", .warnings = shared.of_all});
  PageBlock remarks, table;
  if (!findings.has_many())
    table = {.folded = "Every property of model and rock", .tables = {comparison_table(findings)}};
  if (is_problem_below && !findings.has_many())
    remarks.warnings.push_back(findings.reference_problem + ".");
  for (const std::string& remark : gap_remarks(findings.all))
    remarks.warnings.push_back(remark + ".");
  if (findings.reference && findings.calibration)
    table.paragraphs.push_back(fmt::format(
      "Of the reference, Young's modulus is taken to be the {} one and Poisson's ratio the {} one, as in the calibration.",
      findings.calibration->elastic.youngs_modulus, findings.calibration->elastic.poissons_ratio));
  if (findings.reference)
    {
      std::string source = findings.reference->rock;
      for (const auto& citation : findings.reference->citations)
        source += (source.empty() ? "" : ". ") + citation;
      if (!source.empty())
        table.paragraphs.push_back("Reference: " + source + ".");
    }
  if (!remarks.warnings.empty())
    section.blocks.push_back(remarks);
  section.blocks.push_back(table);
  return section;
}
} // namespace feldspar

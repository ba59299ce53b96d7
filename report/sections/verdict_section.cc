#include "report/sections/sections.h"

#include "report/pictures/plot_style.h"
#include "report/sections/comparison_table.h"
#include "report/sections/verdict.h"
#include "results/bodies.h"
#include "results/trust.h"

#include <fmt/format.h>

#include <algorithm>
#include <string>

namespace feldspar
{
namespace
{
/// What the input says of it.
std::string material_at_points(const Provenance& made_by)
{
  const auto found = std::find_if(made_by.input.begin(), made_by.input.end(), [](const InputEntry& one) {
    return one.section == "Sample" && one.entry == "Material";
  });
  if (found == made_by.input.end())
    return "";
  return found->value == "grains" ? " with a representative volume of grains at every point"
                                  : " of " + found->value + ", without grains";
}
} // namespace

PageSection verdict_section(const Findings& findings)
{
  PageSection section{"verdict", "Verdict", "Is the model the rock?", {}};
  for (std::size_t n = 0; n < findings.all.size(); ++n)
    {
      PageBlock block = findings.heading_of(n);
      block.warnings = warnings(findings.all[n]);
      if (findings.all[n].kind == SeriesKind::laboratory_curve)
        {
          block.subheading = findings.all[n].label;
          block.chip = plot::colour(findings.all[n], n);
          block.paragraphs.push_back("Measured in a laboratory and evaluated as the model's tests are.");
          block.tables.push_back(measured_table(findings, n));
        }
      else
        {
          const Verdict found = verdict(findings.comparisons[n], findings.reference_problem);
          if (findings.all[n].kind == SeriesKind::finite_elements)
            block.paragraphs.push_back(
              fmt::format("Made on a sample of finite elements{}, and evaluated as tests on specimens of grains are.",
                          material_at_points(findings.all[n].made_by)));
          block.headline = found.headline;
          block.points = found.points;
          if (block.warnings.empty())
            block.paragraphs.push_back("Every check of the section Trust is within its bounds.");
        }
      section.blocks.push_back(block);
    }
  PageBlock table;
  if (!findings.reference_problem.empty())
    table.warnings.push_back(findings.reference_problem + ".");
  for (const std::string& remark : gap_remarks(findings.all))
    table.warnings.push_back(remark + ".");
  table.tables.push_back(comparison_table(findings));
  if (findings.reference)
    {
      std::string source = findings.reference->rock;
      for (const auto& citation : findings.reference->citations)
        source += (source.empty() ? "" : ". ") + citation;
      if (!source.empty())
        table.paragraphs.push_back("Reference: " + source + ".");
    }
  section.blocks.push_back(table);
  return section;
}
} // namespace feldspar

#include "laboratory/named_entries.h"
#include "report/sections/sections.h"

#include "base/append.h"
#include "base/contains.h"
#include "report/pictures/rves.h"
#include "report/sections/text.h"
#include "results/runs/test_groups.h"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

namespace feldspar
{
namespace
{
using namespace text;

/// Positions of the representative volumes (RVEs) that are drawn, with what broke in them.
std::vector<Table> rve_tables(const FinishedTest& test, const std::string& title, const std::string& ending)
{
  if (test.appearance.rves.empty())
    return {};
  Table table{
    "rves_" + test.name + ending,
    fmt::format("{}, seed {}: the representative volumes (RVEs) that are drawn; {} FOLDER --extract CELL:POINT "
                "writes these or any other for ParaView and for {}",
                title, test.record.seed, input_entries::multiscale, input_entries::rve),
    {"RVE", "where", "cell:point", "broken segments", "of all [%]", "in shear"}};
  for (std::size_t k = 0; k < test.appearance.rves.size(); ++k)
    {
      const PointRve& rve = test.appearance.rves[k];
      const auto n_shear =
        std::ranges::count_if(rve.cracks, [](const Crack& crack) { return crack.kind == CrackKind::shear; });
      table.rows.push_back({fmt::format("{}, {}", letter_of_rve(k), rve.which),
                            standing_of(rve, test.appearance.fields), rve.place(), fmt::format("{}", rve.cracks.size()),
                            number(100.0 * broken_share(rve), 2), fmt::format("{}", n_shear)});
    }
  return {table};
}

/// The test of a group that has most to show.
const FinishedTest* with_fields(const TestGroup& group)
{
  if (const auto* test = typical(group))
    return test;
  const auto found =
    std::ranges::find_if(group.tests, [](const FinishedTest* test) { return !test->appearance.fields.nodes.empty(); });
  return found == group.tests.end() ? nullptr : *found;
}
} // namespace

PageSection sample_section(const Findings& findings, PictureBook& book)
{
  PageSection section{"sample", "Sample", "The sample at its end"};
  for (std::size_t n = 0; n < findings.all.size(); ++n)
    {
      const Series& series = findings.all[n];
      if (series.kind != SeriesKind::finite_elements)
        continue;
      std::vector<const FinishedTest*> on_page;
      if (findings.is_in_full(n))
        for (const auto& group : shown(groups_of(series)))
          if (const auto* test = with_fields(group))
            on_page.push_back(test);
      PageBlock heading = findings.heading_of(n);
      std::vector<PageBlock> blocks;
      for (const auto& group : groups_of(series))
        for (const auto* test : group.tests)
          {
            const std::string title = findings.titled(group.title(), series);
            Pictures pictures = pictures_of(sample_figures, *test, title);
            if (!findings.one_folder)
              for (Picture& picture : pictures)
                picture.name += findings.ending_of_files(n);
            if (!contains(on_page, test))
              {
                if (findings.one_folder)
                  book.keep_as_files(std::move(pictures));
                continue;
              }
            PageBlock block{.subheading = title, .pictures = book.keep(std::move(pictures))};
            if (block.pictures.empty())
              continue;
            block.tables = rve_tables(*test, title, findings.one_folder ? "" : findings.ending_of_files(n));
            if (test->appearance.rves.empty())
              block.paragraphs.push_back(
                "The grains of single representative volumes are not in this result folder: it is of before "
                "they were kept, or the test did not come to its end.");
            blocks.push_back(block);
          }
      if (!findings.is_in_full(n))
        continue;
      if (blocks.empty())
        heading.paragraphs.push_back(
          "No picture of the sample: its fields are missing in this result folder, or it has "
          "no grains.");
      if (!heading.subheading.empty() || !heading.paragraphs.empty())
        section.blocks.push_back(heading);
      append(section.blocks, std::move(blocks));
    }
  return section;
}
} // namespace feldspar

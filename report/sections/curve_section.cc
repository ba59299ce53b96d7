#include "report/sections/sections.h"

#include "base/append.h"
#include "report/pictures/curves/curve_pictures.h"
#include "report/sections/tables.h"
#include "results/folder/result_folder.h"

#include <fmt/format.h>

#include <utility>

namespace feldspar
{
PageSection curve_section(const Findings& findings, PictureBook& book)
{
  PageSection section{"curves", "Curves", "Curves"};
  bool is_all_shown = true;
  PageBlock stresses;
  for (std::size_t n = 0; n < findings.all.size(); ++n)
    if (findings.is_in_full(n))
      append(stresses.pictures, book.keep(pictures_of(confinement_figures, findings.among(n))));
  std::vector<PageBlock> further;
  for (auto& group : curve_pictures(findings.pictured))
    if (group.on_page)
      {
        PageBlock block{.folded = group.title + ": cracks and energies",
                        .pictures = book.keep(std::move(group.pictures))};
        stresses.pictures.push_back(std::move(block.pictures.front()));
        block.pictures.erase(block.pictures.begin());
        if (!block.pictures.empty())
          further.push_back(std::move(block));
      }
    else
      {
        is_all_shown = false;
        book.keep_as_files(std::move(group.pictures));
      }
  append(stresses.pictures, book.keep(catalogue_picture(findings.pictured, findings.catalogues)));
  if (!stresses.pictures.empty())
    section.blocks.push_back(std::move(stresses));
  append(section.blocks, std::move(further));
  for (std::size_t n = 0; n < findings.all.size(); ++n)
    {
      if (Table emission =
            emission_table(findings.all[n], n == 0 ? findings.catalogues : std::vector<EmissionCatalogue>());
          !emission.rows.empty() && findings.is_in_full(n))
        {
          emission.name += findings.ending_of_files(n);
          section.blocks.push_back(
            {.folded = findings.titled("Acoustic emission", findings.all[n]), .tables = {std::move(emission)}});
        }
      if (Table stages = stage_table(findings.all[n].tests); !stages.rows.empty())
        {
          stages.name += findings.ending_of_files(n);
          PageBlock block = findings.heading_of(n);
          block.tables.push_back(std::move(stages));
          section.blocks.push_back(block);
        }
    }
  PageBlock remark_below;
  if (section.blocks.empty())
    remark_below.paragraphs.push_back("No test of these series has a curve.");
  else if (!is_all_shown)
    remark_below.paragraphs.push_back(fmt::format(
      "Of the confinements the lowest and the highest are shown; the others are in {}/.", result_file::figures));
  section.blocks.push_back(remark_below);
  append(section.blocks,
         findings.remark_on_pictures(fmt::format("The curves of all are in {}/.", result_file::curves)));
  return section;
}
} // namespace feldspar

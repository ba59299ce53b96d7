#include "report/sections/sections.h"

#include "base/append.h"
#include "report/pictures/crack_pictures.h"
#include "report/pictures/envelope_pictures.h"
#include "report/pictures/space_pictures.h"
#include "results/test_groups.h"

#include <fmt/format.h>

#include <utility>

namespace feldspar
{
PageSection crack_section(const Findings& findings, PictureBook& book)
{
  PageSection section{"cracks", "Cracks", "Cracks", {}};
  for (std::size_t n = 0; n < findings.all.size(); ++n)
    {
      const Series& series = findings.all[n];
      if (series.kind == SeriesKind::laboratory_curve)
        continue;
      PageBlock block = findings.heading_of(n);
      std::vector<Picture> maps;
      std::vector<Picture> fragments;
      for (const auto& group : shown(groups_of(series)))
        if (const auto* test = typical(group))
          {
            const std::string title = findings.titled(group.title(), series);
            append(maps, crack_map(*test, title));
            append(maps, space_picture(*test, title));
            append(fragments, fragment_map(*test, title));
          }
      if (!findings.one_folder)
        for (auto* pictures : {&maps, &fragments})
          for (auto& picture : *pictures)
            picture.name += findings.ending_of_files(n);
      if (maps.empty())
        block.paragraphs.push_back(
          series.kind == SeriesKind::finite_elements
            ? "No crack map: there are no cracks, or no test with a peak, in this result folder."
            : "No crack map: the positions of the grains, or a test with a peak, are missing in this result folder.");
      block.pictures = book.keep(std::move(maps));
      append(block.pictures, book.keep(rose_picture(series)));
      append(block.pictures, book.keep(std::move(fragments)));
      append(block.pictures, book.keep(fragment_size_picture(series, n)));
      section.blocks.push_back(block);
    }
  PageBlock together;
  together.pictures = book.keep(shear_share_picture(findings.all));
  if (!together.pictures.empty())
    section.blocks.push_back(together);
  return section;
}
} // namespace feldspar

#include "report/sections/sections.h"

#include "base/append.h"
#include "report/pictures/figures.h"
#include "results/folder/result_folder.h"
#include "results/runs/test_groups.h"

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
      const auto place = [&](std::vector<Picture> pictures) {
        if (findings.is_in_full(n))
          return book.keep(std::move(pictures));
        book.keep_as_files(std::move(pictures));
        return std::vector<PagePicture>();
      };
      PageBlock block = findings.heading_of(n);
      std::vector<Picture> maps;
      std::vector<Picture> fragments;
      for (const auto& group : shown(groups_of(series)))
        if (const auto* test = typical(group))
          {
            const std::string title = findings.titled(group.title(), series);
            append(maps, pictures_of(crack_figures, *test, title));
            append(fragments, pictures_of(fragment_figures, *test, title));
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
      const SeriesAmong among{findings.all, n, findings.envelopes[n], findings.reference};
      block.pictures = place(pictures_of(direction_figures, among));
      append(block.pictures, place(pictures_of(fragment_size_figures, among)));
      PageBlock of_tests;
      of_tests.folded = findings.titled("Cracks and fragments of each test", series);
      of_tests.pictures = place(std::move(maps));
      append(of_tests.pictures, place(std::move(fragments)));
      if (!findings.is_in_full(n))
        continue;
      section.blocks.push_back(block);
      if (!of_tests.pictures.empty())
        section.blocks.push_back(of_tests);
    }
  PageBlock together;
  const std::vector<StrengthEnvelopes> envelopes = findings.pictured_envelopes();
  together.pictures =
    book.keep(pictures_of(crack_figures_of_all, AllSeries{findings.pictured, envelopes, findings.reference}));
  if (!together.pictures.empty())
    section.blocks.push_back(together);
  append(section.blocks,
         findings.remark_on_pictures(fmt::format("Those of the others are in {}/.", result_file::figures)));
  return section;
}
} // namespace feldspar

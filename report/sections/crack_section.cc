#include "report/sections/sections.h"

#include "base/append.h"
#include "report/pictures/curves/curve_pictures.h"
#include "report/pictures/maps/specimen_data.h"
#include "report/sections/tables.h"
#include "results/folder/result_folder.h"
#include "results/runs/test_groups.h"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

namespace feldspar
{
namespace
{
/// Tests that the viewer shows side by side, and the place of the map that stands for all on paper: that with most cracks.
struct ShownTogether
{
  std::vector<TitledTest> tests;
  std::size_t map = 0;
  std::size_t n_cracks = 0;
};

/// Puts the viewer in the place of one of the maps, and returns this map alone.
std::vector<Picture> taken_for_viewer(const ShownTogether& together, std::vector<Picture>& maps)
{
  std::string story = specimen_data(together.tests);
  if (story.empty())
    return {};
  Picture picture = std::move(maps[together.map]);
  maps.erase(maps.begin() + std::ptrdiff_t(together.map));
  picture.story = std::move(story);
  picture.live_caption = together.tests.size() > 1
                           ? "Segments broken up to the same share of each test's strain at its peak"
                           : "Segments broken up to the place of the slider";
  return {std::move(picture)};
}
} // namespace

PageSection crack_section(const Findings& findings, PictureBook& book)
{
  PageSection section{"cracks", "Cracks", "Cracks"};
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
      ShownTogether together;
      const std::vector<ConfinedCurves> curves = confined_curves(series);
      for (const auto& group : shown(groups_of(series)))
        if (const auto* test = typical(group))
          {
            const std::string title = findings.titled(group.title(), series);
            const std::size_t n_cracks = test->record.cracks.size();
            if (!test->appearance.grains_at_end.empty() && n_cracks > 0 && together.tests.size() < most_specimens)
              {
                const auto curve = std::ranges::find_if(
                  curves, [&](const ConfinedCurves& one) { return one.group.title() == group.title(); });
                together.tests.push_back({test, fmt::format("{}, seed {}", group.title(), test->record.seed),
                                          curve == curves.end() ? "" : curve->colour});
                if (n_cracks > together.n_cracks)
                  {
                    together.map = maps.size();
                    together.n_cracks = n_cracks;
                  }
              }
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
      block.pictures = place(taken_for_viewer(together, maps));
      append(block.pictures, place(pictures_of(crack_figures_of_series, findings.among(n))));
      PageBlock of_tests{.folded = findings.titled("Cracks and fragments of each test", series),
                         .pictures = place(std::move(maps))};
      append(of_tests.pictures, place(std::move(fragments)));
      if (!findings.is_in_full(n))
        continue;
      section.blocks.push_back(block);
      if (Table minerals = mineral_table(series); !minerals.rows.empty())
        {
          minerals.name += findings.ending_of_files(n);
          section.blocks.push_back(
            {.folded = findings.titled("Cracks by mineral", series), .tables = {std::move(minerals)}});
        }
      if (!of_tests.pictures.empty())
        section.blocks.push_back(of_tests);
    }
  const std::vector<StrengthEnvelopes> envelopes = findings.pictured_envelopes();
  if (auto together =
        book.keep(pictures_of(crack_figures_of_all, AllSeries{findings.pictured, envelopes, findings.reference}));
      !together.empty())
    section.blocks.push_back({.pictures = std::move(together)});
  append(section.blocks,
         findings.remark_on_pictures(fmt::format("Those of the others are in {}/.", result_file::figures)));
  return section;
}
} // namespace feldspar

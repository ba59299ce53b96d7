#include "report/sections/sections.h"

#include "base/append.h"
#include "report/pictures/curve_pictures.h"
#include "results/folder/result_folder.h"

#include <fmt/format.h>

#include <string>
#include <utility>

namespace feldspar
{
PageSection curve_section(const Findings& findings, PictureBook& book)
{
  PageSection section{"curves", "Curves", "Curves", {}};
  for (auto& group : curve_pictures(findings.pictured))
    if (group.on_page)
      {
        PageBlock block;
        block.subheading = group.title;
        block.pictures = book.keep(std::move(group.pictures));
        section.blocks.push_back(block);
      }
    else
      book.keep_as_files(std::move(group.pictures));
  PageBlock remark_below;
  remark_below.paragraphs.push_back(
    section.blocks.empty()
      ? std::string("No test of these series has a curve.")
      : fmt::format("Of the confinements the lowest and the highest are shown; the others are in {}/.",
                    result_file::figures));
  section.blocks.push_back(remark_below);
  append(section.blocks,
         findings.remark_on_pictures(fmt::format("The curves of all are in {}/.", result_file::curves)));
  return section;
}
} // namespace feldspar

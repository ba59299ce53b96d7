#include "report/pictures/figures.h"
#include "report/sections/sections.h"

namespace feldspar
{
PageSection study_section(const Findings& findings, PictureBook& book)
{
  PageSection section{"study", "Study", "Results over what was varied", {}};
  PageBlock block;
  for (const std::string& sentence : findings.repeats)
    block.warnings.push_back(sentence + ".");
  block.pictures = book.keep(study_pictures(findings.all));
  if (!block.warnings.empty() || !block.pictures.empty())
    section.blocks.push_back(std::move(block));
  return section;
}
} // namespace feldspar

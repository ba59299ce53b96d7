#include "report/pictures/study_pictures.h"
#include "report/sections/sections.h"

namespace feldspar
{
PageSection study_section(const Findings& findings, PictureBook& book)
{
  PageSection section{"study", "Study", "Results over what was varied", {}};
  if (auto pictures = study_pictures(findings.all); !pictures.empty())
    {
      section.blocks.push_back({});
      section.blocks.back().pictures = book.keep(std::move(pictures));
    }
  return section;
}
} // namespace feldspar

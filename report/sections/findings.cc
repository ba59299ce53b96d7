#include "report/sections/findings.h"

#include "report/pictures/plot_style.h"

#include <fmt/format.h>

namespace feldspar
{
std::string Findings::ending_of_files(const std::size_t n) const
{
  return has_several() ? fmt::format("_{}_{}", n + 1, plot::file_name(all[n].label)) : "";
}

PageBlock Findings::heading_of(const std::size_t n) const
{
  PageBlock block;
  if (has_several())
    {
      block.subheading = all[n].label;
      block.chip = plot::colour(all[n], n);
    }
  return block;
}

std::string Findings::titled(const std::string& title, const Series& series) const
{
  return has_several() ? title + ", " + series.label : title;
}
} // namespace feldspar

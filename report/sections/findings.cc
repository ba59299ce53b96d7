#include "report/sections/findings.h"

#include "report/pictures/plot_style.h"

#include <fmt/format.h>

namespace feldspar
{
std::string Findings::ending_of_files(const std::size_t n) const
{
  return has_several() ? fmt::format("_{}_{}", n + 1, plot::file_name(all[n].label)) : "";
}

std::vector<StrengthEnvelopes> Findings::pictured_envelopes() const
{
  std::vector<StrengthEnvelopes> result;
  for (std::size_t n = 0; n < all.size(); ++n)
    if (is_in_full(n))
      result.push_back(envelopes[n]);
  return result;
}

std::vector<PageBlock> Findings::remark_on_pictures(const std::string& others) const
{
  if (!has_many())
    return {};
  return {PageBlock{.paragraphs = {fmt::format("Pictures show the first {} of {} series. {}", most_series_in_full,
                                               all.size(), others)}}};
}

PageBlock Findings::heading_of(const std::size_t n) const
{
  return has_several() ? PageBlock{.subheading = all[n].label, .chip = plot::colour(all[n], n)} : PageBlock();
}

std::string Findings::titled(const std::string& title, const Series& series) const
{
  return has_several() ? title + ", " + series.label : title;
}
} // namespace feldspar

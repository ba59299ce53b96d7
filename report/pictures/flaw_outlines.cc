#include "report/pictures/flaw_outlines.h"

#include "report/pictures/plot_style.h"

#include <fmt/format.h>

#include <iterator>

namespace feldspar
{
using namespace plot;

FlawOutlines flaw_outlines(const FinishedTest& test, const std::string& owner)
{
  constexpr const char* colour = "#202020";
  const std::size_t axis = test.record.size[2] > 0.0 ? 2 : 1;
  FlawOutlines outlines;
  const auto add = [&](const bool open, const char* const name, const std::string& style) {
    std::string rows;
    for (const auto& flaw : test.appearance.flaws)
      if (flaw.open == open)
        {
          for (const auto& point : flaw.outline)
            fmt::format_to(std::back_inserter(rows), "{:.6g} {:.6g}\n", point[0] / milli, point[axis] / milli);
          rows += "\n";
        }
    if (rows.empty())
      return;
    const std::string block = data_block(name, owner);
    outlines.data += fmt::format("{} << EOD\n{}EOD\n", block, rows);
    outlines.plots += fmt::format(", {} using 1:2 with lines {}", block, style);
  };
  add(true, "open", fmt::format("lw 1.2 lc rgb '{}' notitle", colour));
  add(false, "closed", fmt::format("lw 3 lc rgb '{}' title 'flaw'", colour));
  return outlines;
}
} // namespace feldspar

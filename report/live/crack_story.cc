#include "report/live/crack_story.h"

#include "base/prefixes.h"

#include "report/live/chart.h"
#include "report/live/group_colour.h"

#include <fmt/format.h>

#include <algorithm>
#include <iterator>
#include <vector>

namespace feldspar
{
namespace
{
constexpr std::size_t most_rows = 300;
constexpr std::size_t most_grains = 12'000; ///< some 250 kB
constexpr std::size_t most_cracks = 20'000;
} // namespace

std::string crack_story(const FinishedTest& test)
{
  const TestRecord& record = test.record;
  const auto& grains = test.appearance.grains_at_end;
  if (record.curve.empty() || record.cracks.empty() || grains.empty() || grains.size() > most_grains ||
      record.cracks.size() > most_cracks)
    return "";
  const bool in_space = record.dimension() == 3;
  const std::size_t axis = in_space ? 2 : 1;

  // A crack belongs to the first of the rows that is not before it.
  std::vector<const CurveSample*> kept;
  for (std::size_t k = 0; k < record.curve.size(); k += 1 + record.curve.size() / most_rows)
    kept.push_back(&record.curve[k]);
  if (kept.back() != &record.curve.back())
    kept.push_back(&record.curve.back());
  std::string rows;
  for (const CurveSample* row : kept)
    fmt::format_to(std::back_inserter(rows), "{}[{},{},{},{}]", rows.empty() ? "" : ",",
                   live::number(record.kind.strain(*row) / milli), live::number(record.kind.stress(*row) / mega, 4),
                   row->n_tension_cracks, row->n_shear_cracks);
  std::string circles;
  const auto colours = group_colours(grains);
  for (std::size_t i = 0; i < grains.size(); ++i)
    fmt::format_to(std::back_inserter(circles), "{}[{},{},{}{}]", circles.empty() ? "" : ",",
                   live::number(grains[i].start[0] / milli, 4), live::number(grains[i].start[axis] / milli, 4),
                   live::number(grains[i].radius / milli, 3),
                   grains[i].mineral == 0 ? "" : fmt::format(R"(,"#{:06x}")", colours[i]));
  std::string cracks;
  for (const auto& crack : record.cracks)
    {
      const auto row =
        std::lower_bound(kept.begin(), kept.end() - 1, crack.step,
                         [](const CurveSample* one, const std::uint64_t step) { return one->step < step; });
      fmt::format_to(std::back_inserter(cracks), "{}[{},{},{},{},{},{}]", cracks.empty() ? "" : ",",
                     live::number(crack.centroid[0] / milli, 4), live::number(crack.centroid[axis] / milli, 4),
                     live::number(-crack.normal[axis] * crack.size / milli, 3),
                     live::number(crack.normal[0] * crack.size / milli, 3), crack.kind == CrackKind::shear ? 1 : 0,
                     row - kept.begin());
    }
  std::string flaws;
  for (const auto& flaw : test.appearance.flaws)
    {
      std::string outline;
      for (const auto& point : flaw.outline)
        fmt::format_to(std::back_inserter(outline), "{}[{},{}]", outline.empty() ? "" : ",",
                       live::number(point[0] / milli, 4), live::number(point[axis] / milli, 4));
      fmt::format_to(std::back_inserter(flaws), R"({}{{"open":{},"outline":[{}]}})", flaws.empty() ? "" : ",",
                     flaw.open, outline);
    }
  return fmt::format(R"({{"what":"cracks","across":"x [mm]","up":"{} [mm]","strain":{},"stress":{},)"
                     R"("rows":[{}],"grains":[{}],"flaws":[{}],"cracks":[{}]}})",
                     in_space ? 'z' : 'y', live::text(std::string(record.kind.channel.strain_name) + " [10⁻³]"),
                     live::text(std::string(record.kind.channel.name) + " [MPa]"), rows, circles, flaws, cracks);
}
} // namespace feldspar

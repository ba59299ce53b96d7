#include "report/pictures/maps/crack_story.h"

#include "base/prefixes.h"

#include "report/chart/page_writer.h"
#include "report/pictures/maps/group_colour.h"

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <vector>

namespace feldspar
{
namespace
{
constexpr std::size_t most_rows_of_story = 300;
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
  for (std::size_t k = 0; k < record.curve.size(); k += 1 + record.curve.size() / most_rows_of_story)
    kept.push_back(&record.curve[k]);
  if (kept.back() != &record.curve.back())
    kept.push_back(&record.curve.back());
  using Json = nlohmann::ordered_json;
  using live::number;
  Json rows = Json::array();
  for (const CurveSample* row : kept)
    rows.push_back({number(record.kind.strain(*row) / milli), number(record.kind.stress(*row) / mega, 4),
                    row->n_tension_cracks, row->n_shear_cracks});
  Json circles = Json::array();
  const auto colours = group_colours(grains);
  for (std::size_t i = 0; i < grains.size(); ++i)
    {
      circles.push_back({number(grains[i].start[0] / milli, 4), number(grains[i].start[axis] / milli, 4),
                         number(grains[i].radius / milli, 3)});
      if (grains[i].mineral != 0)
        circles.back().push_back(fmt::format("#{:06x}", colours[i]));
    }
  Json cracks = Json::array();
  for (const auto& crack : record.cracks)
    {
      const auto row =
        std::lower_bound(kept.begin(), kept.end() - 1, crack.step,
                         [](const CurveSample* one, const std::uint64_t step) { return one->step < step; });
      cracks.push_back({number(crack.centroid[0] / milli, 4), number(crack.centroid[axis] / milli, 4),
                        number(-crack.normal[axis] * crack.size / milli, 3),
                        number(crack.normal[0] * crack.size / milli, 3), crack.kind == CrackKind::shear ? 1 : 0,
                        row - kept.begin()});
    }
  Json flaws = Json::array();
  for (const auto& flaw : test.appearance.flaws)
    {
      Json outline = Json::array();
      for (const auto& point : flaw.outline)
        outline.push_back({number(point[0] / milli, 4), number(point[axis] / milli, 4)});
      flaws.push_back({{"open", flaw.open}, {"outline", outline}});
    }
  return live::text({{"what", "cracks"},
                     {"across", "x [mm]"},
                     {"up", in_space ? "z [mm]" : "y [mm]"},
                     {"strain", std::string(record.kind.channel.strain_name) + " [10⁻³]"},
                     {"stress", std::string(record.kind.channel.name) + " [MPa]"},
                     {"rows", rows},
                     {"grains", circles},
                     {"flaws", flaws},
                     {"cracks", cracks}});
}
} // namespace feldspar

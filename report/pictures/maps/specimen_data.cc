#include "report/pictures/maps/specimen_data.h"

#include "base/colour.h"
#include "base/mapped.h"
#include "base/prefixes.h"
#include "report/chart/page_writer.h"
#include "report/pictures/maps/group_colour.h"
#include "report/pictures/maps/map.h"
#include "report/pictures/maps/near_grains.h"
#include "results/emission.h"

#include <nlohmann/json.hpp>

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstdint>
#include <limits>
#include <utility>

namespace feldspar
{
namespace
{
using Json = nlohmann::ordered_json;

constexpr std::size_t most_rows = 300;
constexpr std::size_t most_grains = 200'000; ///< of all tests: 5 to 6 MB
constexpr std::size_t most_cracks = 100'000; ///< of all tests: some 2 MB
constexpr std::size_t most_events = 20'000;  ///< of all tests: some 0.8 MB

/// Whole numbers of a few bytes each, the lowest byte first, as the script reads them.
class Bytes
{
public:
  void add(const std::int64_t value, const int n_bytes)
  {
    for (int k = 0; k < n_bytes; ++k)
      bytes += char((std::uint64_t(value) >> (8 * k)) & 0xffU);
  }

  /// A share between 0 and 1.
  void add_share(const double share) { add(std::lround(std::clamp(share, 0.0, 1.0) * 65535.0), 2); }

  /// A share between -1 and 1.
  void add_signed(const double share, const int n_bytes)
  {
    add(std::lround(std::clamp(share, -1.0, 1.0) * (n_bytes == 1 ? 127.0 : 32767.0)), n_bytes);
  }

  void add_float(const double value) { add(std::bit_cast<std::uint32_t>(float(value)), 4); }

  std::string text() const { return live::base64(bytes); }

private:
  std::string bytes;
};

/// The cube around all centres [m].
struct Cube
{
  std::array<double, 3> low;
  double span;

  void add_place(Bytes& bytes, const std::array<double, 3>& place) const
  {
    for (std::size_t c = 0; c < 3; ++c)
      bytes.add_share((place[c] - low[c]) / span);
  }
};

Cube cube_around(const TestRecord& record, const std::vector<GrainPicture>& grains)
{
  Limits<3> limits;
  for (const GrainPicture& grain : grains)
    limits.include(grain.start);
  for (const Crack& crack : record.cracks)
    limits.include(crack.centroid);
  const double span = std::max({limits.size(0), limits.size(1), limits.size(2)});
  return {limits.low, span > 0.0 ? span : 1.0};
}

/// One of how many is kept.
std::size_t stride_of(const std::size_t n, const std::size_t most) { return n > most ? 1 + (n - 1) / most : 1; }

/// The colour of each grain's mineral: 0xRRGGBB, half way to white, so that cracks stand out.
unsigned int pale(const unsigned int colour) { return ((colour >> 1U) & 0x7f7f7fU) + 0x808080U; }

std::vector<unsigned int> mineral_colours(const std::vector<GrainPicture>& grains,
                                          const std::vector<MineralShare>& minerals)
{
  return mapped<unsigned int>(grains, [&](const GrainPicture& grain) {
    return grain.mineral > 0 && grain.mineral <= minerals.size() ? pale(minerals[grain.mineral - 1].mineral.colour)
                                                                 : 0xffffffU;
  });
}

Json grain_data(const std::vector<GrainPicture>& grains, const std::vector<MineralShare>& minerals,
                const std::size_t most, const Cube& cube, const double largest_radius)
{
  const std::size_t every = stride_of(grains.size(), most);
  const auto moved = [](const GrainPicture& grain, const std::size_t c) { return grain.position[c] - grain.start[c]; };
  double most_moved = std::numeric_limits<double>::min();
  double most_stress = 0.0;
  for (const GrainPicture& grain : grains)
    {
      for (std::size_t c = 0; c < 3; ++c)
        most_moved = std::max(most_moved, std::abs(moved(grain, c)));
      most_stress = std::max(most_stress, std::abs(grain.mean_stress));
    }
  const bool has_groups = std::ranges::any_of(grains, [](const GrainPicture& grain) { return grain.group != 0; });
  const auto colours = !minerals.empty() ? mineral_colours(grains, minerals)
                       : has_groups      ? group_colours(grains)
                                         : std::vector<unsigned int>();
  Bytes places, moves, fragments, tones, stresses;
  for (std::size_t i = 0; i < grains.size(); i += every)
    {
      cube.add_place(places, grains[i].start);
      places.add_share(grains[i].radius / largest_radius);
      for (std::size_t c = 0; c < 3; ++c)
        moves.add_signed(moved(grains[i], c) / most_moved, 2);
      fragments.add(std::min<std::uint32_t>(grains[i].fragment, 65535), 2);
      for (int shift = 16; !colours.empty() && shift >= 0; shift -= 8)
        tones.add(colours[i] >> shift, 1);
      if (most_stress > 0.0)
        stresses.add_signed(grains[i].mean_stress / most_stress, 2);
    }
  return {{"every", every},
          {"most_moved", live::number(most_moved / milli)},
          {"place", places.text()},
          {"moved", moves.text()},
          {"fragment", fragments.text()},
          {"tone", tones.text()},
          {"most_stress", live::number(most_stress / mega)},
          {"stress", stresses.text()}};
}

/// The first of the rows that is not before a step.
std::size_t row_of(const std::uint64_t step, const std::vector<const CurveSample*>& rows)
{
  return std::size_t(std::ranges::lower_bound(rows.begin(), rows.end() - 1, step, {}, &CurveSample::step) -
                     rows.begin());
}

Json crack_data(const std::vector<Crack>& cracks, const std::vector<GrainPicture>& grains,
                const std::vector<const CurveSample*>& rows, const Cube& cube, const std::size_t most,
                const double largest_size)
{
  const std::size_t every = stride_of(cracks.size(), most);
  const NearGrains near(grains);
  std::vector<double> opening;
  for (std::size_t k = 0; k < cracks.size(); k += every)
    opening.push_back(near.opening(cracks[k]));
  const double most_open = opening.empty() ? 0.0 : std::max(*std::ranges::max_element(opening), 1e-12);
  Bytes places, normals, of_rows, joints, openings;
  for (const double one : opening)
    openings.add_share(one / most_open);
  for (std::size_t k = 0; k < cracks.size(); k += every)
    {
      const Crack& crack = cracks[k];
      cube.add_place(places, crack.centroid);
      places.add_share(crack.size / largest_size);
      for (const double x : crack.normal)
        normals.add_signed(x, 1);
      normals.add(crack.kind == CrackKind::shear ? 1 : 0, 1);
      of_rows.add(std::int64_t(row_of(crack.step, rows)), 2);
      joints.add(std::int64_t(crack.joint), 4);
    }
  return {{"every", every},         {"place", places.text()}, {"normal", normals.text()},
          {"row", of_rows.text()},  {"joint", joints.text()}, {"most_open", live::number(1e6 * most_open)},
          {"open", openings.text()}};
}

/// The events of the largest magnitudes, the largest first. The full size begins a unit above the magnitude that one event in a
/// hundred exceeds: the collapse of a body may be an event much larger than all before.
Json event_data(const TestRecord& record, const std::vector<const CurveSample*>& rows, const Cube& cube,
                const std::size_t most)
{
  std::vector<std::pair<SourceMechanism, const EmissionEvent*>> events;
  for (const EmissionEvent& event : record.events)
    if (const auto source = mechanism(event, record.dimension()); std::isfinite(source.magnitude))
      events.emplace_back(source, &event);
  std::ranges::stable_sort(
    events, [](const auto& one, const auto& other) { return one.first.magnitude > other.first.magnitude; });
  const std::size_t left_out = events.size() - std::min(events.size(), most);
  events.resize(events.size() - left_out);
  const double full_size =
    events.empty() ? std::numeric_limits<double>::quiet_NaN()
                   : std::min(events.front().first.magnitude, events[events.size() / 100].first.magnitude + 1.0);
  Bytes places, of_rows, kinds, numbers, breaks, measures;
  for (const auto& [source, event] : events)
    {
      cube.add_place(places, event->centroid);
      places.add_share(0.0); // the script's size
      of_rows.add(std::int64_t(row_of(event->step, rows)), 2);
      kinds.add(source.kind == "tensile" ? 0 : source.kind == "shear" ? 1 : 2, 1);
      numbers.add(std::int64_t(event->number), 4);
      breaks.add(std::int64_t(event->n_breaks()), 4);
      for (const double measure : {source.magnitude, event->extent / milli, event->released_energy / milli})
        measures.add_float(measure);
    }
  return {{"left_out", left_out},    {"full_size", live::number(full_size)},
          {"place", places.text()},  {"row", of_rows.text()},
          {"kind", kinds.text()},    {"number", numbers.text()},
          {"breaks", breaks.text()}, {"measures", measures.text()}};
}

Json in_millimetres(const std::array<double, 3>& place)
{
  return {live::number(place[0] / milli), live::number(place[1] / milli), live::number(place[2] / milli)};
}

Json flaw_data(const std::vector<FlawPicture>& flaws)
{
  return mapped<Json>(flaws, [](const FlawPicture& flaw) {
    return Json{{"open", flaw.open}, {"outline", mapped<Json>(flaw.outline, in_millimetres)}};
  });
}

bool is_shown(const TitledTest& one)
{
  return !one.test->record.curve.empty() && !one.test->appearance.grains_at_end.empty();
}

/// One of `n` tests.
Json data_of(const TitledTest& one, const std::size_t n)
{
  const FinishedTest& test = *one.test;
  const TestRecord& record = test.record;
  const auto& grains = test.appearance.grains_at_end;
  std::vector<const CurveSample*> kept;
  for (std::size_t k = 0; k < record.curve.size(); k += 1 + record.curve.size() / most_rows)
    kept.push_back(&record.curve[k]);
  if (kept.back() != &record.curve.back())
    kept.push_back(&record.curve.back());
  Json rows = Json::array();
  for (const CurveSample* row : kept)
    rows.push_back({live::number(record.kind.strain(*row) / milli), live::number(record.kind.stress(*row) / mega, 4),
                    row->n_tension_cracks, row->n_shear_cracks});

  Json minerals = Json::array();
  for (const MineralShare& one_of : record.minerals)
    minerals.push_back({one_of.mineral.name, colour_text(pale(one_of.mineral.colour))});

  Json stages = Json::array(); // which a picture shows
  for (const MapStage& stage : map_stages(record))
    stages.push_back({stage.title, row_of(stage.last_step, kept)});

  // In the order of breaking, so that those broken up to a row are the first.
  std::vector<Crack> cracks = record.cracks;
  std::ranges::stable_sort(cracks, {}, &Crack::step);
  const Cube cube = cube_around(record, grains);
  double radius = std::numeric_limits<double>::min();
  double mean_radius = 0.0;
  for (const GrainPicture& grain : grains)
    {
      radius = std::max(radius, grain.radius);
      mean_radius += grain.radius / double(grains.size());
    }
  double size = std::numeric_limits<double>::min();
  for (const Crack& crack : cracks)
    size = std::max(size, crack.size);
  return {{"title", one.title},
          {"colour", one.colour},
          {"space", record.dimension() == 3},
          {"strain", std::string(record.kind.channel.strain_name) + " [10⁻³]"},
          {"low", in_millimetres(cube.low)},
          {"span", live::number(cube.span / milli)},
          {"radius", live::number(radius / milli)},
          {"size", live::number(size / milli)},
          {"gap", live::number(record.specimen.installation_gap_ratio * mean_radius / milli)},
          {"rows", rows},
          {"minerals", minerals},
          {"stages", stages},
          {"grains", grain_data(grains, record.minerals, most_grains / n, cube, radius)},
          {"flaws", flaw_data(test.appearance.flaws)},
          {"cracks", crack_data(cracks, grains, kept, cube, most_cracks / n, size)},
          {"events", event_data(record, kept, cube, most_events / n)}};
}
} // namespace

std::string specimen_data(const std::vector<TitledTest>& tests, const ShownOnPaper on_paper)
{
  const auto n = std::size_t(std::ranges::count_if(tests, is_shown));
  Json all = Json::array();
  for (const TitledTest& one : tests)
    if (is_shown(one))
      all.push_back(data_of(one, n));
  return n == 0
           ? ""
           : live::text({{"what", "specimens"}, {"fragments", on_paper == ShownOnPaper::fragments}, {"tests", all}});
}
} // namespace feldspar

#include "report/sections/tables.h"

#include "report/sections/text.h"
#include "results/emission.h"
#include "results/runs/test_groups.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <map>
#include <string>
#include <tuple>
#include <utility>

namespace feldspar
{
using namespace text;

Table emission_table(const Series& series, const std::vector<EmissionCatalogue>& catalogues)
{
  constexpr double no_end = std::numeric_limits<double>::infinity(); // waves may lift the stress above its peak
  constexpr std::size_t n_kinds = 3;
  static constexpr std::array<double, 4> shares{-no_end, 0.5, 0.8, no_end};
  static constexpr std::array names{"up to 50 %", "50 to 80 %", "80 % to the peak"};
  Table table{"emission",
              "Acoustic emission by the share of the peak deviator, all tests of a kind together",
              {"test", "deviator", "events", "breaks an event", "largest magnitude", "complete from", "b", "b-positive",
               "tensile [%]", "shear [%]", "implosive [%]"}};
  const auto add = [&](const std::string& title, const std::string& window, const std::vector<double>& magnitudes,
                       const double step, const std::size_t n_events, const double n_breaks) {
    const auto frequency = magnitude_frequency(magnitudes, step);
    double largest = -no_end;
    for (const double one : magnitudes)
      largest = std::max(largest, one);
    table.rows.push_back(
      {title, window, fmt::format("{}", n_events), n_breaks > 0.0 ? number(n_breaks / double(n_events), 2) : none,
       std::isfinite(largest) ? number(largest, 2) : none, frequency ? number(frequency->completeness, 2) : none,
       frequency ? fmt::format("{:.2f} ± {:.2f}", frequency->b, frequency->error) : none,
       frequency ? number(frequency->b_positive, 2) : none});
  };
  for (const auto& group : groups_of(series))
    for (std::size_t w = 0; w < names.size(); ++w)
      {
        std::vector<double> magnitudes;
        std::array<double, n_kinds> n_of_kind{};
        std::size_t n_events = 0;
        double n_breaks = 0.0;
        for (const auto* test : group.tests)
          {
            magnitudes.push_back(std::numeric_limits<double>::quiet_NaN());
            for (const EmissionEvent& event :
                 events_up_to_peak(test->record, test->results.strain_at_peak.value, shares[w], shares[w + 1]))
              {
                const SourceMechanism source = mechanism(event, test->record.dimension());
                ++n_events;
                n_breaks += double(event.n_breaks());
                magnitudes.push_back(source.magnitude);
                n_of_kind[0] += source.kind == "tensile";
                n_of_kind[1] += source.kind == "shear";
                n_of_kind[2] += source.kind == "implosive";
              }
          }
        if (n_events == 0)
          continue;
        add(group.title(), names[w], magnitudes, 0.0, n_events, n_breaks);
        for (const double n : n_of_kind)
          table.rows.back().push_back(number(100.0 * n / double(n_events), 0));
      }
  for (const EmissionCatalogue& catalogue : catalogues)
    {
      const std::vector<double> magnitudes = catalogue.magnitudes_to_peak();
      add(catalogue.name, "to the peak", magnitudes, catalogue.step(), magnitudes.size(), 0.0);
      table.rows.back().insert(table.rows.back().end(), n_kinds, none);
    }
  return table;
}

namespace
{
/// "in quartz", "quartz | mica".
std::string place_of(const Crack& crack, const std::vector<MineralShare>& minerals)
{
  const auto name = [&](const std::uint32_t number) {
    return number <= minerals.size() ? minerals[number - 1].mineral.name : std::string("?");
  };
  return crack.on_boundary ? name(crack.mineral_1) + " | " + name(crack.mineral_2) : "in " + name(crack.mineral_1);
}
} // namespace

Table mineral_table(const Series& series)
{
  static constexpr std::array<double, 3> shares{0.5, 0.8, 1.0};
  Table table{
    "minerals",
    "Cracks in minerals and at boundaries between mineral grains up to shares of the strain at the peak, all tests of a "
    "kind together",
    {"test", "place", "cracks up to 50 %", "up to 80 %", "up to the peak", "of all at the peak [%]", "in shear [%]"}};
  struct Place
  {
    std::string name = {}; ///< in quartz; quartz | mica
    std::array<std::size_t, shares.size()> up_to{};
    std::size_t in_shear = 0;
  };
  for (const auto& group : groups_of(series))
    {
      std::map<std::tuple<bool, std::uint32_t, std::uint32_t>, Place> places;
      std::size_t all = 0;
      for (const auto* test : group.tests)
        if (const auto& peak = test->results.strain_at_peak.value)
          for (const Crack& crack : test->record.cracks)
            if (const double share = test->record.kind.sign * crack.axial_strain / *peak;
                crack.mineral_1 > 0 && share <= shares.back())
              {
                auto& [name, up_to, in_shear] = places[{crack.on_boundary, crack.mineral_1, crack.mineral_2}];
                name = place_of(crack, test->record.minerals);
                for (std::size_t k = 0; k < shares.size(); ++k)
                  up_to[k] += share <= shares[k];
                in_shear += crack.kind == CrackKind::shear;
                ++all;
              }
      for (const auto& [key, place] : places)
        {
          const auto& [name, up_to, in_shear] = place;
          const double n = double(up_to.back());
          table.rows.push_back({group.title(), name, fmt::format("{}", up_to[0]), fmt::format("{}", up_to[1]),
                                fmt::format("{}", up_to[2]), number(100.0 * n / double(all), 1),
                                number(100.0 * double(in_shear) / n, 1)});
        }
    }
  return table;
}
} // namespace feldspar

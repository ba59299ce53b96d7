#include "report/sections/test_tables.h"

#include "report/sections/text.h"
#include "results/emission.h"
#include "results/runs/test_groups.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

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
               "tensile [%]", "shear [%]", "implosive [%]"},
              {}};
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
} // namespace feldspar

#include "report/sections/test_tables.h"

#include "report/sections/text.h"
#include "results/emission.h"
#include "results/runs/test_groups.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <limits>

namespace feldspar
{
using namespace text;

Table emission_table(const Series& series)
{
  constexpr double no_end = std::numeric_limits<double>::infinity(); // waves may lift the stress above its peak
  static constexpr std::array<double, 4> shares{-no_end, 0.5, 0.8, no_end};
  static constexpr std::array names{"up to 50 %", "50 to 80 %", "80 % to the peak"};
  Table table{"emission",
              "Acoustic emission by the share of the peak deviator, all tests of a kind together",
              {"test", "deviator", "events", "breaks an event", "largest magnitude", "complete from magnitude", "b",
               "b-positive", "tensile [%]", "shear [%]", "implosive [%]"},
              {}};
  for (const auto& group : groups_of(series))
    for (std::size_t w = 0; w < names.size(); ++w)
      {
        std::vector<double> magnitudes;
        std::array<double, 3> n_of_kind{};
        double n_events = 0.0, n_breaks = 0.0;
        double largest = -no_end;
        for (const auto* test : group.tests)
          {
            magnitudes.push_back(std::numeric_limits<double>::quiet_NaN());
            for (const EmissionEvent& event :
                 events_between(test->record, test->results.strain_at_peak.value, shares[w], shares[w + 1]))
              {
                const SourceMechanism source = mechanism(event, test->record.dimension());
                ++n_events;
                n_breaks += double(event.n_breaks());
                magnitudes.push_back(source.magnitude);
                largest = std::max(largest, source.magnitude);
                n_of_kind[0] += source.kind == "tensile";
                n_of_kind[1] += source.kind == "shear";
                n_of_kind[2] += source.kind == "implosive";
              }
          }
        if (n_events == 0.0)
          continue;
        const auto frequency = magnitude_frequency(magnitudes);
        table.rows.push_back({group.title(), names[w], number(n_events, 0), number(n_breaks / n_events, 2),
                              number(largest, 2), frequency ? number(frequency->completeness, 1) : none,
                              frequency ? fmt::format("{:.2f} ± {:.2f}", frequency->b, frequency->error) : none,
                              frequency ? number(frequency->b_positive, 2) : none});
        for (const double n : n_of_kind)
          table.rows.back().push_back(number(100.0 * n / n_events, 0));
      }
  return table;
}
} // namespace feldspar

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

namespace
{
constexpr double no_end = std::numeric_limits<double>::infinity(); // waves may lift the stress above its peak

/// Shares of the highest stress, of which each window has two.
constexpr std::array<double, 4> shares{-no_end, 0.5, 0.8, no_end};
constexpr std::array windows{"up to 50 %", "50 to 80 %", "80 % to the peak"};

/// The cells of largest magnitude, b and b-positive.
std::array<std::string, 3> cells_of(const std::vector<double>& magnitudes,
                                    const std::optional<MagnitudeFrequency>& fall)
{
  double largest = -no_end;
  for (const double one : magnitudes)
    largest = std::max(largest, one);
  return {number(largest, 2), fall ? fmt::format("{:.2f} ± {:.2f}", fall->b, fall->error) : none,
          fall ? number(fall->b_positive, 2) : none};
}
} // namespace

Table emission_table(const Series& series)
{
  Table table{"emission",
              "Acoustic emission by the share of the peak deviator, all tests of a kind together",
              {"test", "deviator", "events", "breaks an event", "largest magnitude", "b", "b-positive", "tensile [%]",
               "shear [%]", "implosive [%]"},
              {}};
  for (const auto& group : groups_of(series))
    for (std::size_t w = 0; w < windows.size(); ++w)
      {
        std::vector<double> magnitudes;
        std::array<double, 3> n_of_kind{};
        double n_events = 0.0, n_breaks = 0.0;
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
                n_of_kind[0] += source.kind == "tensile";
                n_of_kind[1] += source.kind == "shear";
                n_of_kind[2] += source.kind == "implosive";
              }
          }
        if (n_events == 0.0)
          continue;
        const auto [largest, b, b_positive] = cells_of(magnitudes, magnitude_frequency(magnitudes));
        table.rows.push_back(
          {group.title(), windows[w], number(n_events, 0), number(n_breaks / n_events, 2), largest, b, b_positive});
        for (const double n : n_of_kind)
          table.rows.back().push_back(number(100.0 * n / n_events, 0));
      }
  return table;
}

Table catalogue_table(const std::vector<EmissionCatalogue>& catalogues)
{
  Table table{"emission_catalogues",
              "Acoustic emission of the laboratory by the share of the highest stress, where the file has one",
              {"catalogue", "stress", "events", "largest magnitude", "complete from", "b", "b-positive", "magnitudes"},
              {}};
  for (const EmissionCatalogue& catalogue : catalogues)
    for (std::size_t w = 0; w <= windows.size(); ++w)
      {
        const bool is_all = w == windows.size();
        const std::vector<double> magnitudes =
          catalogue.magnitudes_between(is_all ? -no_end : shares[w], is_all ? no_end : shares[w + 1]);
        if (magnitudes.empty() || (!is_all && !catalogue.has_stress()))
          continue;
        const auto fall = magnitude_frequency(magnitudes, catalogue.step());
        const auto [largest, b, b_positive] = cells_of(magnitudes, fall);
        table.rows.push_back({catalogue.name, is_all ? "all" : windows[w], number(double(magnitudes.size()), 0), largest,
                              fall ? number(fall->completeness, 2) : none, b, b_positive, catalogue.scale});
      }
  return table;
}
} // namespace feldspar

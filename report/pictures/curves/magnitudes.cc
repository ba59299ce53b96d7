#include "base/append.h"
#include "report/pictures/curves/curve_pictures.h"
#include "report/pictures/figures.h"
#include "report/pictures/plot_style.h"
#include "results/emission.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <optional>
#include <string>
#include <vector>

namespace feldspar
{
using namespace plot;

namespace
{
/// Magnitudes of the events up to the peak in their order, test after test.
std::vector<double> magnitudes_to_peak(const TestGroup& group)
{
  std::vector<double> magnitudes;
  for (const auto* test : group.tests)
    {
      magnitudes.push_back(std::numeric_limits<double>::quiet_NaN());
      append(magnitudes, magnitudes_of(events_up_to_peak(test->record, test->results.strain_at_peak.value),
                                       test->record.dimension()));
    }
  return magnitudes;
}

/// Adds the number of events over their magnitude less `zero`, and the line of its fall.
void add_counts(Chart& chart, std::vector<double> magnitudes, const std::optional<MagnitudeFrequency>& frequency,
                const double zero, const std::string& beginning, const std::string& colour)
{
  constexpr double finest = 0.01; // magnitudes that a figure tells apart
  std::erase_if(magnitudes, [](const double one) { return !std::isfinite(one); });
  if (magnitudes.empty())
    return;
  std::ranges::sort(magnitudes, std::greater<>());
  ChartSeries counts{.label = fmt::format("{}{} events", beginning, magnitudes.size()), .colour = colour};
  for (std::size_t k = 0; k < magnitudes.size(); ++k)
    if (k + 1 == magnitudes.size() || std::floor(magnitudes[k + 1] / finest) < std::floor(magnitudes[k] / finest))
      counts.points.push_back({magnitudes[k] - zero, double(k + 1)});
  if (frequency)
    {
      ChartSeries line{.label = fmt::format("{}b = {:.2f} ± {:.2f}", beginning, frequency->b, frequency->error),
                       .colour = colour,
                       .dashes = 2};
      const double fall = frequency->b * (magnitudes.front() - frequency->completeness);
      line.points.push_back({frequency->completeness - zero, double(frequency->n)});
      line.points.push_back({magnitudes.front() - zero, double(frequency->n) * std::pow(10.0, -fall)});
      chart.series.push_back(std::move(line));
    }
  chart.series.push_back(std::move(counts));
}

} // namespace

Pictures magnitude_picture(const SameTests& same)
{
  Chart chart{.x = {.label = "moment magnitude"},
              .y = {.label = "events of this magnitude or more", .logarithmic = true},
              .key_columns = 2};
  for (const auto& of : same)
    {
      const std::vector<double> magnitudes = magnitudes_to_peak(of.group);
      add_counts(chart, magnitudes, magnitude_frequency(magnitudes), 0.0,
                 same.size() > 1 ? of.series->label + ", " : "", colour(*of.series, of.n));
    }
  return curve_picture(
    std::move(chart), same, "_magnitudes",
    std::string("Acoustic emission up to the peak: number of events over their magnitude") +
      (any_has_several(same) ? "; all tests of a series together" : ""),
    fmt::format("Number of events of acoustic emission over their magnitude in {}.", same.front().group.title()));
}

Pictures catalogue_picture(const std::vector<Series>& all, const std::vector<EmissionCatalogue>& catalogues)
{
  Chart chart{.x = {.label = "magnitude above completeness"},
              .y = {.label = "events of this magnitude or more", .logarithmic = true},
              .key_columns = 2};
  std::string caption =
    "Acoustic emission of the laboratory and of the model, up to the peak: number of events over their "
    "magnitude above completeness";
  const auto add = [&](const std::vector<double>& magnitudes, const double step, const std::string& name,
                       const std::string& its_colour) {
    if (const auto frequency = magnitude_frequency(magnitudes, step))
      add_counts(chart, magnitudes, frequency, frequency->completeness, name + ", ", its_colour);
  };
  for (const EmissionCatalogue& catalogue : catalogues)
    {
      add(catalogue.magnitudes_to_peak(), catalogue.step(), catalogue.name, black);
      caption += fmt::format("; magnitudes of {}: {}", catalogue.name, catalogue.scale);
    }
  if (chart.empty())
    return {};
  std::size_t n_lines = 0;
  for (const Series& series : all)
    for (const TestGroup& group : shown(groups_of(series)))
      add(magnitudes_to_peak(group), 0.0, all.size() > 1 ? group.title() + ", " + series.label : group.title(),
          colour(series, n_lines++));
  return picture_of(std::move(chart), 580, 450, "emission_catalogues", caption,
                    "Number of events of acoustic emission over magnitude, of the laboratory and of the model.");
}
} // namespace feldspar

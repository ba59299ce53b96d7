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
#include <vector>

namespace feldspar
{
using namespace plot;

Pictures magnitude_picture(const SameTests& same)
{
  constexpr double infinity = std::numeric_limits<double>::infinity();
  Chart chart{.x = {.label = "moment magnitude"},
              .y = {.label = "events of this magnitude or more", .logarithmic = true},
              .key_columns = 2};
  for (const auto& of : same)
    {
      std::vector<double> magnitudes; // in the order of the events, test after test
      for (const auto* test : of.group.tests)
        {
          magnitudes.push_back(std::numeric_limits<double>::quiet_NaN());
          append(magnitudes,
                 magnitudes_of(events_between(test->record, test->results.strain_at_peak.value, -infinity, infinity),
                               test->record.dimension()));
        }
      const auto frequency = magnitude_frequency(magnitudes);
      std::erase_if(magnitudes, [](const double one) { return !std::isfinite(one); });
      if (magnitudes.empty())
        continue;
      std::sort(magnitudes.begin(), magnitudes.end(), std::greater<>());
      const std::string beginning = same.size() > 1 ? of.series->label + ", " : "";
      ChartSeries counts{.label = fmt::format("{}{} events", beginning, magnitudes.size()),
                         .colour = colour(*of.series, of.n)};
      for (std::size_t k = 0; k < magnitudes.size(); ++k)
        if (k + 1 == magnitudes.size() || magnitudes[k + 1] < magnitudes[k])
          counts.points.push_back({magnitudes[k], double(k + 1)});
      if (frequency)
        {
          ChartSeries line{.label = fmt::format("{}b = {:.2f} ± {:.2f}", beginning, frequency->b, frequency->error),
                           .colour = counts.colour,
                           .dashes = 2};
          const double fall = frequency->b * (magnitudes.front() - frequency->completeness);
          line.points.push_back({frequency->completeness, double(frequency->n)});
          line.points.push_back({magnitudes.front(), double(frequency->n) * std::pow(10.0, -fall)});
          chart.series.push_back(std::move(line));
        }
      chart.series.push_back(std::move(counts));
    }
  return curve_picture(
    std::move(chart), same, "_magnitudes",
    std::string("Acoustic emission up to the peak: number of events over their magnitude") +
      (any_has_several(same) ? "; all tests of a series together" : ""),
    fmt::format("Number of events of acoustic emission over their magnitude in {}.", same.front().group.title()));
}
} // namespace feldspar

#include "report/pictures/curves/curve_pictures.h"
#include "report/pictures/figures.h"
#include "report/pictures/plot_style.h"
#include "results/emission.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <string_view>
#include <utility>
#include <vector>

namespace feldspar
{
namespace
{
using namespace plot;

struct Source
{
  double scalar_moment; ///< [N m]
  std::string_view kind;
  HudsonPlace place;
};

/// The events of all tests of a series up to their peaks, the largest first.
std::vector<Source> sources_of(const SeriesGroup& of)
{
  std::vector<Source> sources;
  for (const auto* test : of.group.tests)
    {
      const int dimension = test->record.dimension();
      for (const EmissionEvent& event : events_up_to_peak(test->record, test->results.strain_at_peak.value))
        if (const SourceMechanism source = mechanism(event, dimension); !source.kind.empty())
          sources.push_back({source.scalar_moment, source.kind, hudson_place(event, dimension)});
    }
  std::ranges::stable_sort(
    sources, [](const Source& one, const Source& other) { return one.scalar_moment > other.scalar_moment; });
  return sources;
}

/// In space: the diamond with the places of simple sources, and the largest events by their mechanisms.
Chart diamond(std::vector<Source> sources)
{
  constexpr std::size_t most = 2000;
  sources.resize(std::min(sources.size(), most));
  Chart chart{.x = {.from = -1.4, .to = 1.4, .bare = true},
              .y = {.from = -1.1, .to = 1.2, .bare = true},
              .equal_scales = true,
              .key_columns = 3,
              .series = {{.colour = grey,
                          .width = 1.0,
                          .points = {{0.0, 1.0}, {4.0 / 3, 1.0 / 3}, {0.0, -1.0}, {-4.0 / 3, -1.0 / 3}, {0.0, 1.0}}}}};
  for (const auto& [kind, of_colour] :
       {std::pair{"tensile", tension_colour}, std::pair{"shear", shear_colour}, std::pair{"implosive", olive}})
    {
      ChartSeries marks{.kind = ChartSeries::Kind::marks,
                        .label = kind,
                        .colour = of_colour,
                        .width = 1.0,
                        .size = 0.35};
      for (const Source& source : sources)
        if (source.kind == kind)
          marks.points.push_back({source.place.u, source.place.v});
      chart.series.push_back(std::move(marks));
    }
  chart.series.push_back({.kind = ChartSeries::Kind::marks,
                          .colour = black,
                          .width = 1.4,
                          .mark = 2,
                          .size = 0.8,
                          .points = {{0.0, 1.0}, {-4.0 / 9, 5.0 / 9}, {-2.0 / 3, 1.0 / 3}, {0.0, 0.0}, {0.0, -1.0}}});
  chart.series.push_back({.kind = ChartSeries::Kind::texts,
                          .colour = black,
                          .size = 11.0,
                          .points = {{0.0, 1.09}, {-0.72, 0.62}, {-0.9, 0.36}, {0.0, -0.1}, {0.25, -1.04}},
                          .texts = {"explosion", "opening crack", "dipole", "double couple", "implosion"}});
  return chart;
}
} // namespace

/// In the plane, where the third eigenvalue is not known, all sources lie on the upright axis of the diamond.
Pictures source_picture(const SameTests& same)
{
  constexpr std::size_t n_bins = 40;
  const int dimension = same.front().group.tests.front()->record.dimension();
  Chart chart{.x = {.label = "mean eigenvalue of the moment tensor over the largest", .from = -1.0, .to = 1.0},
              .y = {.label = "share of the events [%]", .from = 0.0},
              .key_columns = 2};
  for (const auto& of : same)
    {
      const auto sources = sources_of(of);
      if (sources.empty())
        continue;
      if (dimension == 3)
        {
          chart = diamond(sources);
          break; // marks of a second series would hide those of the first
        }
      std::array<double, n_bins> share{};
      for (const Source& source : sources)
        share[std::min(n_bins - 1, std::size_t(0.5 * (source.place.v + 1.0) * n_bins))] +=
          1.0 / percent / double(sources.size());
      ChartSeries steps{.kind = ChartSeries::Kind::steps,
                        .label = of.series->label,
                        .colour = colour(*of.series, of.n)};
      for (std::size_t k = 0; k < n_bins; ++k)
        steps.points.push_back({(2.0 * double(k) + 1.0) / n_bins - 1.0, share[k]});
      chart.series.push_back(std::move(steps));
    }
  return curve_picture(std::move(chart), same, "_sources",
                       std::string("Mechanisms of the events of acoustic emission up to the peak") +
                         (dimension == 3
                            ? ", in the diamond of Hudson, Pearce and Rogers (1989)"
                            : ": the upright axis of a Hudson plot, with an explosion at 1, an opening crack "
                              "at 0.67, a dipole at 0.5 and a double couple at 0"),
                       fmt::format("Mechanisms of the events in {}.", same.front().group.title()));
}
} // namespace feldspar

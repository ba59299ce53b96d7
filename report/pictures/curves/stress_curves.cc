#include "report/pictures/curves/curve_pictures.h"
#include "report/pictures/figures.h"
#include "report/pictures/plot_style.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

namespace feldspar
{
namespace
{
using namespace plot;

constexpr std::size_t most_rows = 250; ///< of a single test in a picture

/// Mean strain at the peak: beyond it the gauge measures broken pieces.
double strain_at_peak(const TestGroup& group)
{
  double sum = 0.0;
  const auto strains = values(group, &TestResults::strain_at_peak);
  for (const double strain : strains)
    sum += strain / double(strains.size());
  return sum;
}

/// Stress over a strain, up to `end` of the axial strain; the band lies along the axis along which `sideways` says the
/// tests scatter.
void add_stress_curve(Chart& chart, const SeriesGroup& of, const Quantity& strain, const bool sideways,
                      const double end, const int dashes, const std::string& label, const std::string& its_colour)
{
  const auto& group = of.group;
  const double sign = group.kind.sign;
  const bool each_alone = group.kind.follows_stages; // back and forth, each on its own way
  if (group.tests.size() > 1 || each_alone)
    for (const auto* test : group.tests)
      {
        const auto& curve = test->record.curve;
        const std::size_t stride = 1 + curve.size() / most_rows;
        ChartSeries line{.label = fmt::format("{}, seed {}", label, test->record.seed),
                         .goes_with = each_alone ? "" : label,
                         .colour = its_colour,
                         .width = !each_alone              ? 0.5
                                  : group.tests.size() > 1 ? 1.0
                                                           : 2.2};
        for (std::size_t k = 0; k < curve.size() && sign * curve[k].axial_strain <= end; k += stride)
          line.points.push_back({sign * strain(curve[k]) / milli, group.kind.stress(curve[k]) / mega});
        chart.series.push_back(std::move(line));
      }
  if (each_alone)
    return;

  const Band stress = band(group, group.kind.channel.value, true);
  const Band strains = band(group, strain, true);
  ChartSeries mean{.label = label, .colour = its_colour, .dashes = dashes};
  std::vector<std::array<double, 2>> deviations;
  for (std::size_t k = 0; k < stress.abscissa.size() && stress.abscissa[k] <= end; ++k)
    {
      mean.points.push_back({strains.mean[k] / milli, stress.mean[k] / mega});
      if (group.tests.size() > 1)
        deviations.push_back(
          {sideways ? strains.deviation[k] / milli : 0.0, sideways ? 0.0 : stress.deviation[k] / mega});
    }
  add_mean(chart, std::move(mean), deviations);
}

/// Ends the axis of strain where the axial strain ends: broken pieces move sideways many times as far.
void end_with_axial_strain(Chart& chart)
{
  Limits<2> limits;
  limits.include({0.0, 0.0});
  for (const ChartSeries& series : chart.series)
    for (const auto& [x, y, third, fourth] : series.points)
      if (std::isfinite(x) && std::isfinite(y))
        limits.include({x, y});
  const auto& [axial, highest] = limits.high;
  if (limits.low[0] >= -axial)
    return;
  chart.x.from = -axial;
  chart.x.to = 1.02 * axial;
  chart.y.to = 1.05 * highest;
}
} // namespace

Pictures stress_picture(const SameTests& same)
{
  const TestKind& kind = same.front().group.kind;
  // A test without uniform stress has no uniform strains either.
  const bool is_uniform = kind.has_uniform_stress;
  const bool pulls = kind.sign > 0.0;
  Chart chart{
    .x = {.label = is_uniform ? (pulls ? "strain [10⁻³], extension positive" : "strain [10⁻³], shortening positive")
                              : fmt::format("{} [10⁻³]", kind.channel.strain_name)},
    .y = {.label = is_uniform
                     ? fmt::format("{} [MPa], {} positive", kind.channel.name, pulls ? "tension" : "compression")
                     : fmt::format("{} [MPa]", kind.channel.name),
          .from = 0.0},
    .key_columns = is_uniform ? 3 : 2};
  for (const auto& of : same)
    {
      const std::string beginning =
        same.size() > 1 || of.group.tests.size() > 1 || !of.counts_cracks() ? of.series->key() : std::string();
      const auto label = [&](const std::string& ending) {
        return beginning.empty() ? ending : is_uniform ? beginning + ", " + ending : beginning;
      };
      const std::string its_colour = colour(*of.series, of.n);
      add_stress_curve(chart, of, &CurveSample::axial_strain, false, 1.0, 1,
                       label(std::string(is_uniform ? "axial" : kind.channel.name)), its_colour);
      if (!is_uniform)
        continue;
      const double peak = strain_at_peak(of.group);
      const double end = peak > 0.0 ? peak : 1.0;
      add_stress_curve(chart, of, &CurveSample::gauge_lateral_strain, true, end, 2, label("lateral"), its_colour);
      add_stress_curve(chart, of, &CurveSample::gauge_volumetric_strain, true, end, 4, label("volumetric"), its_colour);
    }
  if (is_uniform && !kind.follows_stages)
    end_with_axial_strain(chart);
  const std::string what = is_uniform
                             ? std::string("Stress against axial, lateral and volumetric strain")
                             : fmt::format("{} against {}", with_capital(kind.channel.name), kind.channel.strain_name);
  return curve_picture(std::move(chart), same, "_stress",
                       same.front().group.title() + ": " + what +
                         (kind.follows_stages ? "" : means_of_several(same, true)) +
                         (is_uniform ? ". Lateral and volumetric strain up to the mean strain at peak" : ""),
                       what + " in " + same.front().group.title() + ".");
}

std::vector<ConfinedCurves> confined_curves(const Series& series)
{
  // From light to dark, as the confinement rises; the orange and the blue of cracks stand beside them.
  constexpr std::array tones{"#d4a6c8", "#b06fb0", "#8446a0", "#332288", "#882255", "#cc6677", "#999933", "#665c00"};
  std::vector<ConfinedCurves> all;
  for (TestGroup& group : groups_of(series))
    if (group.envelope_role() == EnvelopeRole::compression && group.kind.has_uniform_stress &&
        !group.kind.follows_stages &&
        std::ranges::none_of(group.tests, [](const FinishedTest* test) { return test->record.curve.empty(); }))
      all.push_back({std::move(group), tones[all.size() % tones.size()]});
  return all;
}

Pictures compression_curves(const SeriesAmong& of)
{
  Chart chart{.x = {.label = "axial strain [10⁻³], shortening positive", .from = 0.0},
              .y = {.label = "axial stress [MPa]", .from = 0.0},
              .key_columns = 2};
  SameTests drawn;
  for (const ConfinedCurves& one : confined_curves(of.series()))
    {
      drawn.push_back({&of.series(), of.n, one.group});
      add_stress_curve(chart, drawn.back(), &CurveSample::axial_strain, false, 1.0, 1, one.group.title(), one.colour);
    }
  if (drawn.size() < 2)
    return {};
  std::erase_if(chart.series,
                [](const ChartSeries& one) { return one.kind == ChartSeries::Kind::line && !one.goes_with.empty(); });
  return picture_of(std::move(chart), 660, 520, "compression_" + file_name(of.series().label),
                    (of.all.size() > 1 ? of.series().label + ": stress" : std::string("Stress")) +
                      " against axial strain at every confinement" + means_of_several(drawn),
                    "Axial stress against axial strain in compression, a line for each confinement.");
}
} // namespace feldspar

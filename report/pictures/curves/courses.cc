#include "report/pictures/curves/curve_pictures.h"
#include "report/pictures/figures.h"
#include "report/pictures/plot_style.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <utility>

namespace feldspar
{
namespace
{
using namespace plot;

constexpr std::size_t n_bins = 40;

enum class Scale
{
  as_it_is,
  over_highest ///< over the highest mean
};

/// Mean of a quantity over the tests of a group, over axial strain.
void add_mean_of(Chart& chart, const SeriesGroup& of, const Quantity& quantity, ChartSeries mean,
                 const Scale scale = Scale::as_it_is)
{
  Band over_seeds = band(of.group, quantity, false);
  if (scale == Scale::over_highest && !over_seeds.mean.empty())
    {
      const double highest = *std::ranges::max_element(over_seeds.mean);
      if (!(highest > 0.0))
        return;
      for (auto* const numbers : {&over_seeds.mean, &over_seeds.deviation})
        for (double& number : *numbers)
          number /= highest;
    }
  std::vector<std::array<double, 2>> deviations;
  for (std::size_t k = 0; k < over_seeds.abscissa.size(); ++k)
    {
      mean.points.push_back({over_seeds.abscissa[k] / milli, over_seeds.mean[k]});
      if (of.group.tests.size() > 1)
        deviations.push_back({0.0, over_seeds.deviation[k]});
    }
  add_mean(chart, std::move(mean), deviations);
}

/// Returns whether a value is zero in every row.
template <typename Value>
bool is_nowhere(const SeriesGroup& of, const Value& value)
{
  return std::ranges::all_of(of.group.tests, [&](const FinishedTest* test) {
    return std::ranges::all_of(test->record.curve, [&](const CurveSample& row) { return value(row) == 0.0; });
  });
}

/// Returns whether a single series has cracks; their kinds then have colours of their own.
bool is_one(const SameTests& same)
{
  return std::ranges::count_if(same, [](const auto& of) { return of.counts_cracks(); }) == 1;
}
} // namespace

Pictures crack_count_picture(const SameTests& same)
{
  Chart chart{.x = {.label = abscissa_label(same)}, .y = {.label = "broken segments", .from = 0.0}, .key_columns = 2};
  const bool one = is_one(same);
  for (const auto& of : same)
    if (of.counts_cracks())
      {
        const std::string beginning = one ? "" : of.series->label + ", ";
        const std::string series_colour = colour(*of.series, of.n);
        add_mean_of(chart, of, [](const CurveSample& row) { return double(row.n_tension_cracks); },
                    {.label = beginning + "tension cracks", .colour = one ? tension_colour : series_colour});
        add_mean_of(chart, of, [](const CurveSample& row) { return double(row.n_shear_cracks); },
                    {.label = beginning + "shear cracks", .colour = one ? shear_colour : series_colour, .dashes = 2});
      }
  const bool any_rves =
    std::ranges::any_of(same, [](const auto& of) { return of.series->kind == SeriesKind::finite_elements; });
  const std::string of_rves =
    any_rves
      ? ". Of finite elements those of the representative volumes at all points, more than the sample itself would have"
      : "";
  return curve_picture(std::move(chart), same, "_cracks", "Broken segments" + means_of_several(same) + of_rves,
                       fmt::format("Number of tension and of shear cracks against {} in {}.", abscissa_name(same),
                                   same.front().group.title()));
}

Pictures energy_picture(const SameTests& same)
{
  const auto of = std::ranges::find_if(same, [](const auto& one) { return one.counts_cracks(); });
  if (of == same.end())
    return {};
  struct Part
  {
    const char* label;
    double Energies::*member;
    const char* colour;
    int dashes;
  };
  static constexpr std::array parts{Part{"boundary work", &Energies::boundary_work, black, 1},
                                    Part{"strain energy", &Energies::strain, indigo, 1},
                                    Part{"damping", &Energies::damping, teal, 4},
                                    Part{"friction", &Energies::slip, olive, 2},
                                    Part{"released by breaks", &Energies::released, wine, 1},
                                    Part{"stress redistribution", &Energies::redistribution, sand, 2},
                                    Part{"kinetic", &Energies::kinetic, rose, 3}};
  Chart chart{.x = {.label = abscissa_label(same)}, .y = {.label = "energy [J]", .from = 0.0}, .key_columns = 3};
  for (const auto& part : parts)
    {
      const auto energy = [&](const CurveSample& row) { return row.energies.*part.member; };
      if (!is_nowhere(*of, energy)) // grains have no elements between which stress is redistributed
        add_mean_of(chart, *of, energy, {.label = part.label, .colour = part.colour, .dashes = part.dashes});
    }
  return curve_picture(std::move(chart), same, "_energy",
                       "Where the work of the boundaries went" +
                         (same.size() > 1 ? ", " + of->series->label : std::string()) + means_of_several({*of}),
                       fmt::format("Energies against {} in {}.", abscissa_name(same), same.front().group.title()));
}

Pictures emission_picture(const SameTests& same)
{
  const auto of = std::ranges::find_if(same, [](const auto& one) { return one.counts_cracks(); });
  if (of == same.end())
    return {};
  const auto hits = [](const CurveSample& row) { return double(row.n_tension_cracks + row.n_shear_cracks); };
  if (is_nowhere(*of, hits))
    return {};
  Chart chart{.x = {.label = abscissa_label(same)}, .y = {.label = "over the highest", .from = 0.0}, .key_columns = 3};
  const TestKind& kind = of->group.kind;
  add_mean_of(
    chart, *of, [&](const CurveSample& row) { return kind.stress(row); }, {.label = "stress", .colour = black},
    Scale::over_highest);
  add_mean_of(chart, *of, hits, {.label = "hits so far", .colour = teal, .dashes = 2}, Scale::over_highest);
  add_mean_of(
    chart, *of, [](const CurveSample& row) { return row.energies.released; },
    {.label = "energy they released so far", .colour = wine}, Scale::over_highest);
  return curve_picture(std::move(chart), same, "_emission",
                       "Course of the acoustic emission: a hit is the break of a segment" +
                         (same.size() > 1 ? ", " + of->series->label : std::string()) + means_of_several({*of}),
                       fmt::format("Stress, number of hits and their energy against {} in {}.", abscissa_name(same),
                                   same.front().group.title()));
}

Pictures crack_rate_picture(const SameTests& same)
{
  if (same.front().group.kind.follows_stages) // cracks have their strain, which goes back and forth
    return {};
  double end = 0.0;
  for (const auto& of : same)
    for (const auto* test : of.group.tests)
      if (!test->record.curve.empty())
        end = std::max(end, of.group.kind.sign * test->record.curve.back().axial_strain);
  Chart chart{.x = {.label = abscissa_label(same), .from = 0.0},
              .y = {.label = "cracks per 10⁻³ of strain", .from = 0.0},
              .right = {.label = "released energy [J per 10⁻³ of strain]", .from = 0.0},
              .key_columns = 2};
  const bool one = is_one(same);
  for (const auto& of : same)
    {
      if (!of.counts_cracks() || !(end > 0.0))
        continue;
      const double sign = of.group.kind.sign;
      const double bin = end / n_bins;
      std::array<double, n_bins> hits{};
      std::array<double, n_bins> energy{};
      double n_tests = 0.0;
      bool any = false;
      for (const auto* test : of.group.tests)
        {
          n_tests += !test->record.curve.empty();
          for (const auto& crack : test->record.cracks)
            {
              const double place = sign * crack.axial_strain / bin;
              const auto k = std::size_t(std::clamp(place, 0.0, double(n_bins - 1)));
              hits[k] += 1.0;
              energy[k] += crack.released_energy;
              any = true;
            }
        }
      if (!any || n_tests == 0.0)
        continue;
      const std::string beginning = one ? "" : of.series->label + ", ";
      ChartSeries rate{.kind = ChartSeries::Kind::steps,
                       .label = beginning + "cracks",
                       .colour = colour(*of.series, of.n),
                       .width = 2.0};
      ChartSeries power{.kind = ChartSeries::Kind::steps,
                        .label = beginning + "released energy",
                        .colour = one ? wine : rate.colour,
                        .width = 1.6,
                        .dashes = one ? 1 : 2,
                        .to_the_right = true};
      for (std::size_t k = 0; k < n_bins; ++k)
        {
          const double x = (double(k) + 0.5) * bin / milli;
          rate.points.push_back({x, hits[k] / n_tests / (bin / milli)});
          power.points.push_back({x, energy[k] / n_tests / (bin / milli)});
        }
      chart.series.push_back(std::move(rate));
      chart.series.push_back(std::move(power));
    }
  return curve_picture(
    std::move(chart), same, "_crack_rate",
    std::string("Rate of the hits of acoustic emission: cracks and the energy they released, per strain") +
      (any_has_several(same) ? "; mean of the tests of a series" : ""),
    fmt::format("Histogram of cracks and of the energy they released over {} in {}.",
                same.front().group.kind.channel.strain_name, same.front().group.title()));
}
} // namespace feldspar

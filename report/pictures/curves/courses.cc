#include "report/pictures/curves/courses.h"

#include "report/pictures/curves/curve_plot.h"
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

/// Mean of a quantity over the tests of a group, over axial strain.
void add_mean(CurvePlot& plot, const SeriesGroup& of, const Quantity& quantity, const std::string& of_colour,
              const int dashes, const std::string& label)
{
  const Band over_seeds = band(of.group, quantity, false);
  CurvePlot::Mean mean{label, of_colour, dashes, {}, {}, {}};
  for (std::size_t k = 0; k < over_seeds.abscissa.size(); ++k)
    {
      const double x = over_seeds.abscissa[k] / milli;
      mean.points.push_back({x, over_seeds.mean[k]});
      mean.above.push_back({x, over_seeds.mean[k] + over_seeds.deviation[k]});
      mean.below.push_back({x, over_seeds.mean[k] - over_seeds.deviation[k]});
    }
  plot.add(std::move(mean), of.group.tests.size() > 1);
}

/// Zero in every row.
template <typename Value>
bool is_nowhere(const SeriesGroup& of, const Value& value)
{
  return std::all_of(of.group.tests.begin(), of.group.tests.end(), [&](const FinishedTest* test) {
    return std::all_of(test->record.curve.begin(), test->record.curve.end(),
                       [&](const CurveSample& row) { return value(row) == 0.0; });
  });
}
} // namespace

std::optional<Picture> crack_count_picture(const SameTests& same, const std::string& name, const std::string& of_tests)
{
  CurvePlot plot;
  const bool one = std::count_if(same.begin(), same.end(), [](const auto& of) { return of.counts_cracks(); }) == 1;
  for (const auto& of : same)
    if (of.counts_cracks())
      {
        const std::string beginning = one ? "" : of.series->label + ", ";
        const std::string series_colour = colour(*of.series, of.n);
        add_mean(
          plot, of, [](const CurveSample& row) { return double(row.n_tension_cracks); },
          one ? tension_colour : series_colour, 1, beginning + "tension cracks");
        add_mean(
          plot, of, [](const CurveSample& row) { return double(row.n_shear_cracks); },
          one ? shear_colour : series_colour, 2, beginning + "shear cracks");
      }
  if (plot.empty())
    return std::nullopt;
  const bool any_rves = std::any_of(same.begin(), same.end(),
                                    [](const auto& of) { return of.series->kind == SeriesKind::finite_elements; });
  const std::string of_rves =
    any_rves
      ? ". Of finite elements those of the representative volumes at all points, more than the sample itself would have"
      : "";
  const Chart axes{.x_label = abscissa_label(same), .y_label = "broken segments"};
  return Picture{.name = name + "_cracks",
                 .caption = "Broken segments" + means_of_several(same) + of_rves,
                 .alternative = fmt::format("Number of tension and of shear cracks against {} in {}.",
                                            abscissa_name(same), of_tests),
                 .width = CurvePlot::width,
                 .height = plot.height(2),
                 .script = plot.script(axes, "set yrange [0:*]\nset key maxcols 2\n"),
                 .live = plot.json(axes)};
}

std::optional<Picture> energy_picture(const SameTests& same, const std::string& name, const std::string& of_tests)
{
  const auto of = std::find_if(same.begin(), same.end(), [](const auto& one) { return one.counts_cracks(); });
  if (of == same.end())
    return std::nullopt;
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
  CurvePlot plot;
  for (const auto& part : parts)
    {
      const auto energy = [&](const CurveSample& row) { return row.energies.*part.member; };
      if (is_nowhere(*of, energy)) // grains have no elements between which stress is redistributed
        continue;
      add_mean(plot, *of, energy, part.colour, part.dashes, part.label);
    }
  if (plot.empty())
    return std::nullopt;
  const Chart axes{.x_label = abscissa_label(same), .y_label = "energy [J]"};
  return Picture{.name = name + "_energy",
                 .caption = "Where the work of the boundaries went" +
                            (same.size() > 1 ? ", " + of->series->label : std::string()) + means_of_several({*of}),
                 .alternative = fmt::format("Energies against {} in {}.", abscissa_name(same), of_tests),
                 .width = CurvePlot::width,
                 .height = plot.height(3),
                 .script = plot.script(axes, "set yrange [0:*]\nset key maxcols 3\n"),
                 .live = plot.json(axes)};
}

std::optional<Picture> crack_rate_picture(const SameTests& same, const std::string& name, const std::string& of_tests)
{
  if (same.front().group.kind.follows_stages) // cracks have their strain, which goes back and forth
    return std::nullopt;
  double end = 0.0;
  for (const auto& of : same)
    for (const auto* test : of.group.tests)
      if (!test->record.curve.empty())
        end = std::max(end, of.group.kind.sign * test->record.curve.back().axial_strain);
  CurvePlot plot;
  const bool one = std::count_if(same.begin(), same.end(), [](const auto& of) { return of.counts_cracks(); }) == 1;
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
      CurvePlot::Points rate;
      CurvePlot::Points power;
      for (std::size_t k = 0; k < n_bins; ++k)
        {
          const double x = (double(k) + 0.5) * bin / milli;
          rate.push_back({x, hits[k] / n_tests / (bin / milli)});
          power.push_back({x, energy[k] / n_tests / (bin / milli)});
        }
      const std::string beginning = one ? "" : of.series->label + ", ";
      const std::string series_colour = colour(*of.series, of.n);
      plot.add(1, {.kind = CurvePlot::Kind::steps,
                   .label = beginning + "cracks",
                   .colour = series_colour,
                   .width = 2.0,
                   .points = std::move(rate)});
      plot.add(2, {.kind = CurvePlot::Kind::steps,
                   .label = beginning + "released energy",
                   .colour = one ? wine : series_colour,
                   .width = 1.6,
                   .dashes = one ? 1 : 2,
                   .to_the_right = true,
                   .points = std::move(power)});
    }
  if (plot.empty())
    return std::nullopt;
  const Chart axes{.x_label = abscissa_label(same),
                   .y_label = "cracks per 10⁻³ of strain",
                   .right_label = "released energy [J per 10⁻³ of strain]"};
  return Picture{
    .name = name + "_crack_rate",
    .caption = "Crack rate, to be held against acoustic emission: cracks and the energy they released, per strain" +
               std::string(any_has_several(same) ? "; mean of the tests of a series" : ""),
    .alternative = fmt::format("Histogram of cracks and of the energy they released over {} in {}.",
                               same.front().group.kind.channel.strain_name, of_tests),
    .width = CurvePlot::width,
    .height = plot.height(2),
    .script =
      plot.script(axes, fmt::format("set y2label {}\nset border 11\nset y2tics nomirror out\n"
                                    "set xrange [0:*]; set yrange [0:*]; set y2range [0:*]\nset key maxcols 2\n",
                                    gnuplot_text(axes.right_label))),
    .live = plot.json(axes)};
}
} // namespace feldspar

#include "report/pictures/curve_pictures.h"

#include "report/pictures/plot_style.h"
#include "results/test_groups.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <iterator>
#include <optional>
#include <utility>

namespace feldspar
{
namespace
{
using namespace plot;

constexpr int width = 580;
constexpr int height = 450;
constexpr std::size_t most_rows = 250; ///< of a single test in a picture
constexpr std::size_t n_bins = 40;

/// The tests of one kind and pressure in one of the series.
struct SeriesGroup
{
  const Series* series;
  std::size_t n; ///< of the series
  TestGroup group;

  /// And energies.
  bool counts_cracks() const
  {
    return series->kind != SeriesKind::laboratory_curve &&
           std::none_of(group.tests.begin(), group.tests.end(), [](const FinishedTest* test) {
             const bool is_continuum =
               test->record.body == TestBody::finite_elements && test->record.specimen.n_joints == 0;
             return is_continuum ||
                    (!test->record.curve.empty() && std::isnan(test->record.curve.back().energies.strain));
           });
  }
};

using SameTests = std::vector<SeriesGroup>;

/// Data blocks and plot entries in the making.
class Plot
{
public:
  std::string add_data(const std::string& rows)
  {
    const std::string block = fmt::format("$data{}", n_blocks++);
    data += fmt::format("{} << EOD\n{}EOD\n", block, rows);
    return block;
  }

  /// Layers are drawn from 0 upwards.
  void add(const std::size_t layer, std::string entry) { layers[layer].push_back(std::move(entry)); }

  std::string script(const std::string& set_up) const
  {
    std::string text = data + set_up + "plot ";
    bool first = true;
    for (const auto& layer : layers)
      for (const auto& entry : layer)
        {
          text += (first ? "" : ", \\\n") + entry;
          first = false;
        }
    return text + "\n";
  }

  bool empty() const
  {
    return std::all_of(layers.begin(), layers.end(), [](const auto& layer) { return layer.empty(); });
  }

private:
  std::string data;
  std::array<std::vector<std::string>, 3> layers;
  int n_blocks = 0;
};

using Quantity = std::function<double(const CurveSample&)>;

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
void add_stress_curve(Plot& plot, const SeriesGroup& of, const Quantity& strain, const bool sideways, const double end,
                      const std::string& line, const std::string& label)
{
  const auto& group = of.group;
  const double sign = group.kind.sign;
  const std::string series_colour = colour(*of.series, of.n);
  if (group.tests.size() > 1)
    for (const auto* test : group.tests)
      {
        const auto& curve = test->record.curve;
        const std::size_t stride = 1 + curve.size() / most_rows;
        std::string rows;
        for (std::size_t k = 0; k < curve.size() && sign * curve[k].axial_strain <= end; k += stride)
          fmt::format_to(std::back_inserter(rows), "{:.5g} {:.5g}\n", sign * strain(curve[k]) / milli,
                         group.kind.stress(curve[k]) / mega);
        if (!rows.empty())
          plot.add(1, fmt::format("{} using 1:2 with lines lw 0.5 lc rgb '{}' notitle", plot.add_data(rows),
                                  "#90" + series_colour.substr(1)));
      }

  const Band stress = band(
    group, [&](const CurveSample& row) { return row.*group.kind.channel.value; }, true);
  const Band strains = band(group, strain, true);
  std::string rows;
  std::string there;
  std::string back;
  for (std::size_t k = 0; k < stress.strain.size() && stress.strain[k] <= end; ++k)
    {
      const double x = strains.mean[k] / milli;
      const double y = stress.mean[k] / mega;
      const double dx = sideways ? strains.deviation[k] / milli : 0.0;
      const double dy = sideways ? 0.0 : stress.deviation[k] / mega;
      fmt::format_to(std::back_inserter(rows), "{:.5g} {:.5g}\n", x, y);
      there += fmt::format("{:.5g} {:.5g}\n", x + dx, y + dy);
      back = fmt::format("{:.5g} {:.5g}\n", x - dx, y - dy) + back;
    }
  if (rows.empty())
    return;
  if (group.tests.size() > 1)
    plot.add(0, fmt::format("{} using 1:2 with filledcurves closed fill solid 0.18 noborder lc rgb '{}' notitle",
                            plot.add_data(there + back), series_colour));
  plot.add(2, fmt::format("{} using 1:2 with lines lw 2.2 {} lc rgb '{}' {}", plot.add_data(rows), line, series_colour,
                          title(label)));
}

std::optional<Picture> stress_picture(const SameTests& same, const std::string& name, const std::string& of_tests)
{
  Plot plot;
  for (const auto& of : same)
    {
      const std::string beginning =
        same.size() > 1 || of.group.tests.size() > 1 || !of.counts_cracks() ? of.series->label + ", " : std::string();
      add_stress_curve(
        plot, of, [](const CurveSample& row) { return row.axial_strain; }, false, 1.0, "", beginning + "axial");
      if (!of.group.kind.has_uniform_stress)
        continue; // nor uniform strains
      const double peak = strain_at_peak(of.group);
      const double end = peak > 0.0 ? peak : 1.0;
      add_stress_curve(
        plot, of, [](const CurveSample& row) { return row.gauge_lateral_strain; }, true, end, "dt 2",
        beginning + "lateral");
      add_stress_curve(
        plot, of, [](const CurveSample& row) { return row.gauge_volumetric_strain; }, true, end, "dt 4",
        beginning + "volumetric");
    }
  if (plot.empty())
    return std::nullopt;
  const TestKind& kind = same.front().group.kind;
  const bool pulls = kind.sign > 0.0;
  return Picture{
    .name = name + "_stress",
    .caption =
      "Stress against axial, lateral and volumetric strain. Lines: means; bands: ± standard deviation; thin: single "
      "tests. Lateral and volumetric strain up to the mean strain at peak",
    .alternative = "Stress against axial, lateral and volumetric strain in " + of_tests + ".",
    .width = width,
    .height = height,
    .script =
      plot.script(frame(pulls ? "strain [10⁻³], extension positive" : "strain [10⁻³], shortening positive",
                        fmt::format("{} [MPa], {} positive", kind.channel.name, pulls ? "tension" : "compression")) +
                  "set xzeroaxis; set yzeroaxis lw 0.8 lc rgb '#b0b0b0'\nset yrange [0:*]\nset key maxcols 3\n")};
}

/// Mean of a quantity over the tests of a group, over axial strain.
void add_mean(Plot& plot, const SeriesGroup& of, const Quantity& quantity, const std::string& looks,
              const std::string& label)
{
  const Band over_seeds = band(of.group, quantity, false);
  std::string rows;
  for (std::size_t k = 0; k < over_seeds.strain.size(); ++k)
    fmt::format_to(std::back_inserter(rows), "{:.5g} {:.5g} {:.5g}\n", over_seeds.strain[k] / milli,
                   over_seeds.mean[k] - over_seeds.deviation[k], over_seeds.mean[k] + over_seeds.deviation[k]);
  if (rows.empty())
    return;
  const std::string block = plot.add_data(rows);
  if (of.group.tests.size() > 1)
    plot.add(0, fmt::format("{} using 1:2:3 with filledcurves fill solid 0.18 noborder {} notitle", block,
                            looks.substr(looks.find("lc "))));
  plot.add(2, fmt::format("{} using 1:(0.5*($2+$3)) with lines lw 2.2 {} {}", block, looks, title(label)));
}

std::optional<Picture> crack_count_picture(const SameTests& same, const std::string& name, const std::string& of_tests)
{
  Plot plot;
  const bool one = std::count_if(same.begin(), same.end(), [](const auto& of) { return of.counts_cracks(); }) == 1;
  for (const auto& of : same)
    if (of.counts_cracks())
      {
        const std::string beginning = one ? "" : of.series->label + ", ";
        const std::string series_colour = colour(*of.series, of.n);
        add_mean(
          plot, of, [](const CurveSample& row) { return double(row.n_tension_cracks); },
          fmt::format("lc rgb '{}'", one ? tension_colour : series_colour), beginning + "tension cracks");
        add_mean(
          plot, of, [](const CurveSample& row) { return double(row.n_shear_cracks); },
          fmt::format("dt 2 lc rgb '{}'", one ? shear_colour : series_colour), beginning + "shear cracks");
      }
  if (plot.empty())
    return std::nullopt;
  const bool any_volumes = std::any_of(same.begin(), same.end(),
                                       [](const auto& of) { return of.series->kind == SeriesKind::finite_elements; });
  const std::string of_volumes =
    any_volumes
      ? ". Of finite elements those of the representative volumes at all points, more than the sample itself would have"
      : "";
  return Picture{.name = name + "_cracks",
                 .caption = "Broken segments. Lines: means; bands: ± standard deviation" + of_volumes,
                 .alternative = "Number of tension and of shear cracks against axial strain in " + of_tests + ".",
                 .width = width,
                 .height = height,
                 .script = plot.script(frame("axial strain [10⁻³]", "broken segments") + "set yrange [0:*]\n")};
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

/// Of one series, for its lines are enough.
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
                                    Part{"strain energy", &Energies::strain, blue, 1},
                                    Part{"damping", &Energies::damping, sky, 4},
                                    Part{"friction", &Energies::slip, green, 2},
                                    Part{"released by breaks", &Energies::released, vermillion, 1},
                                    Part{"stress redistribution", &Energies::redistribution, sky, 2},
                                    Part{"kinetic", &Energies::kinetic, purple, 3}};
  Plot plot;
  for (const auto& part : parts)
    {
      const auto energy = [&](const CurveSample& row) { return row.energies.*part.member; };
      if (is_nowhere(*of, energy)) // grains have no elements between which stress is redistributed
        continue;
      add_mean(plot, *of, energy, fmt::format("dt {} lc rgb '{}'", part.dashes, part.colour), part.label);
    }
  if (plot.empty())
    return std::nullopt;
  return Picture{
    .name = name + "_energy",
    .caption = "Where the work of the boundaries went" + (same.size() > 1 ? ", " + of->series->label : std::string()) +
               ". Lines: means; bands: ± standard deviation",
    .alternative = "Energies against axial strain in " + of_tests + ".",
    .width = width,
    .height = height,
    .script = plot.script(frame("axial strain [10⁻³]", "energy [J]") + "set yrange [0:*]\nset key maxcols 3\n")};
}

/// Cracks and their released energy per strain, as acoustic emission is shown.
std::optional<Picture> crack_rate_picture(const SameTests& same, const std::string& name, const std::string& of_tests)
{
  double end = 0.0;
  for (const auto& of : same)
    for (const auto* test : of.group.tests)
      if (!test->record.curve.empty())
        end = std::max(end, of.group.kind.sign * test->record.curve.back().axial_strain);
  Plot plot;
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
      std::string rows;
      for (std::size_t k = 0; k < n_bins; ++k)
        fmt::format_to(std::back_inserter(rows), "{:.5g} {:.5g} {:.5g}\n", (double(k) + 0.5) * bin / milli,
                       hits[k] / n_tests / (bin / milli), energy[k] / n_tests / (bin / milli));
      const std::string block = plot.add_data(rows);
      const std::string beginning = one ? "" : of.series->label + ", ";
      const std::string series_colour = colour(*of.series, of.n);
      if (one)
        plot.add(
          0, fmt::format("{} using 1:2 with boxes fill solid 0.35 noborder lc rgb '{}' title 'cracks'", block, blue));
      else
        plot.add(1, fmt::format("{} using 1:2 with histeps lw 2 lc rgb '{}' {}", block, series_colour,
                                title(beginning + "cracks")));
      plot.add(2, fmt::format("{} using 1:3 axes x1y2 with histeps lw 1.6 dt {} lc rgb '{}' {}", block, one ? 1 : 2,
                              one ? vermillion : series_colour, title(beginning + "released energy")));
    }
  if (plot.empty())
    return std::nullopt;
  return Picture{
    .name = name + "_crack_rate",
    .caption = "Crack rate, to be held against acoustic emission: cracks and the energy they released, per "
               "strain; mean of the tests",
    .alternative = "Histogram of cracks and of the energy they released over axial strain in " + of_tests + ".",
    .width = width,
    .height = height,
    .script = plot.script(
      frame("axial strain [10⁻³]", "cracks per 10⁻³ of strain") +
      "set y2label 'released energy [J per 10⁻³ of strain]'\nset border 11\n"
      "set y2tics nomirror out\nset xrange [0:*]; set yrange [0:*]; set y2range [0:*]\nset boxwidth 1 relative\n")};
}
} // namespace

std::vector<GroupPictures> curve_pictures(const std::vector<Series>& all)
{
  // Of every series the tests of the same kind and pressure.
  std::vector<std::pair<TestGroup, SameTests>> programme;
  std::vector<TestGroup> every;
  for (std::size_t n = 0; n < all.size(); ++n)
    for (const auto& group : groups_of(all[n]))
      {
        auto found = std::find_if(programme.begin(), programme.end(),
                                  [&](const auto& entry) { return same_conditions(entry.first, group); });
        if (found == programme.end())
          found = programme.insert(programme.end(), {group, {}});
        found->second.push_back({&all[n], n, group});
      }
  std::stable_sort(programme.begin(), programme.end(),
                   [](const auto& a, const auto& b) { return comes_before(a.first, b.first); });
  for (const auto& [group, same] : programme)
    every.push_back(group);
  const auto on_page = shown(every);

  std::vector<GroupPictures> result;
  for (const auto& [group, same] : programme)
    {
      const std::string name = group.name();
      const std::string of_tests = group.title();
      const bool is_shown =
        std::any_of(on_page.begin(), on_page.end(), [&](const TestGroup& one) { return one.name() == name; });
      GroupPictures pictures{of_tests, is_shown, {}};
      for (const auto& make : {stress_picture, crack_count_picture, energy_picture, crack_rate_picture})
        if (auto picture = make(same, name, of_tests))
          pictures.pictures.push_back(std::move(*picture));
      if (!pictures.pictures.empty())
        result.push_back(std::move(pictures));
    }
  return result;
}
} // namespace feldspar

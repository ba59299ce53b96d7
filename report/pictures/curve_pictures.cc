#include "report/pictures/curve_pictures.h"

#include "report/live/chart.h"
#include "report/pictures/plot_style.h"
#include "results/runs/test_groups.h"

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
constexpr int plain_height = 450;
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

using Points = std::vector<std::array<double, 2>>;

/// Data blocks and plot entries in the making, and the same for the script of the page.
class Plot
{
public:
  using Kind = ChartLine::Kind;

  /// Layers are drawn from 0 upwards. Of its points the picture and the page show the same.
  void add(const std::size_t layer, ChartLine line)
  {
    if (line.points.empty())
      return;
    std::string rows;
    for (const auto& [x, y] : line.points)
      fmt::format_to(std::back_inserter(rows), "{:.5g} {:.5g}\n", x, y);
    const std::string block = fmt::format("$data{}", n_blocks++);
    data += fmt::format("{} << EOD\n{}EOD\n", block, rows);
    const std::string axes = line.to_the_right ? "axes x1y2 " : "";
    const std::string key = title(line.goes_with.empty() ? line.label : "");
    if (line.kind == Kind::area)
      layers[layer].push_back(
        fmt::format("{} using 1:2 {}with filledcurves closed fill solid 0.18 noborder lc rgb '{}' {}", block, axes,
                    line.colour, key));
    else if (line.kind == Kind::steps)
      layers[layer].push_back(fmt::format("{} using 1:2 {}with histeps lw {} dt {} lc rgb '{}' {}", block, axes,
                                          line.width, line.dashes, line.colour, key));
    else
      layers[layer].push_back(fmt::format("{} using 1:2 {}with lines lw {} dt {} lc rgb '{}{}' {}", block, axes,
                                          line.width, line.dashes, line.goes_with.empty() ? "#" : "#90",
                                          line.colour.substr(1), key));
    if (line.goes_with.empty())
      {
        ++n_keys;
        longest_key = std::max(longest_key, int(line.label.size()));
      }
    of_page[layer].push_back(std::move(line));
  }

  std::string script(const Chart& axes, const std::string& set_up) const
  {
    std::string text = data + frame(axes.x_label, axes.y_label) + set_up + "plot ";
    bool first = true;
    for (const auto& layer : layers)
      for (const auto& entry : layer)
        {
          text += (first ? "" : ", \\\n") + entry;
          first = false;
        }
    return text + "\n";
  }

  std::string json(Chart axes) const
  {
    for (const auto& layer : of_page)
      axes.lines.insert(axes.lines.end(), layer.begin(), layer.end());
    return axes.json();
  }

  bool empty() const
  {
    return std::all_of(layers.begin(), layers.end(), [](const auto& layer) { return layer.empty(); });
  }

  /// Of a picture whose key has at most so many columns, fewer where labels are long: it takes no room from the axes.
  int height(const int columns) const
  {
    constexpr int characters = 72; // in a line of the key
    constexpr int mark = 6;        // before each label, in characters
    constexpr int line = 23;       // [px]
    const int fitting = std::clamp(characters / (longest_key + mark), 1, columns);
    return plain_height + line * std::max(0, (n_keys + fitting - 1) / fitting - 2);
  }

private:
  std::string data;
  std::array<std::vector<std::string>, 3> layers;
  std::array<std::vector<ChartLine>, 3> of_page;
  int n_blocks = 0;
  int n_keys = 0;
  int longest_key = 0; ///< [bytes]
};

/// The meaning of lines and bands, for captions: with one specimen there is nothing to average.
std::string means_and_bands(const bool several)
{
  return several ? ". Lines: means; bands: ± standard deviation; thin lines: single tests" : "";
}

bool any_has_several(const SameTests& same)
{
  return std::any_of(same.begin(), same.end(), [](const SeriesGroup& of) { return of.group.tests.size() > 1; });
}

std::string means_of_several(const SameTests& same)
{
  return any_has_several(same) ? ". Lines: means; bands: ± standard deviation" : "";
}

using Quantity = std::function<double(const CurveSample&)>;

std::string with_capital(const std::string_view words)
{
  std::string text(words);
  if (!text.empty() && text.front() >= 'a' && text.front() <= 'z')
    text.front() = char(text.front() - 'a' + 'A');
  return text;
}

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
                      const int dashes, const std::string& label)
{
  const auto& group = of.group;
  const double sign = group.kind.sign;
  const std::string series_colour = colour(*of.series, of.n);
  const bool each_alone = group.kind.follows_stages; // back and forth, each on its own way
  if (group.tests.size() > 1 || each_alone)
    for (const auto* test : group.tests)
      {
        const auto& curve = test->record.curve;
        const std::size_t stride = 1 + curve.size() / most_rows;
        Points points;
        for (std::size_t k = 0; k < curve.size() && sign * curve[k].axial_strain <= end; k += stride)
          points.push_back({sign * strain(curve[k]) / milli, group.kind.stress(curve[k]) / mega});
        if (each_alone)
          plot.add(2, {.label = fmt::format("{}, seed {}", label, test->record.seed),
                       .colour = series_colour,
                       .width = group.tests.size() > 1 ? 1.0 : 2.2,
                       .points = std::move(points)});
        else
          plot.add(1, {.label = fmt::format("{}, seed {}", label, test->record.seed),
                       .goes_with = label,
                       .colour = series_colour,
                       .width = 0.5,
                       .points = std::move(points)});
      }
  if (each_alone)
    return;

  const Band stress = band(
    group, [&](const CurveSample& row) { return row.*group.kind.channel.value; }, true);
  const Band strains = band(group, strain, true);
  Points mean;
  Points around; // there on one side, back on the other
  Points back;
  for (std::size_t k = 0; k < stress.abscissa.size() && stress.abscissa[k] <= end; ++k)
    {
      const double x = strains.mean[k] / milli;
      const double y = stress.mean[k] / mega;
      const double dx = sideways ? strains.deviation[k] / milli : 0.0;
      const double dy = sideways ? 0.0 : stress.deviation[k] / mega;
      mean.push_back({x, y});
      around.push_back({x + dx, y + dy});
      back.push_back({x - dx, y - dy});
    }
  around.insert(around.end(), back.rbegin(), back.rend());
  if (group.tests.size() > 1)
    plot.add(0, {.kind = Plot::Kind::area,
                 .label = label + ", ± standard deviation",
                 .goes_with = label,
                 .colour = series_colour,
                 .points = std::move(around)});
  plot.add(2, {.label = label, .colour = series_colour, .dashes = dashes, .points = std::move(mean)});
}

std::optional<Picture> stress_picture(const SameTests& same, const std::string& name, const std::string& of_tests)
{
  const TestKind& kind = same.front().group.kind;
  // A test without uniform stress has no uniform strains either.
  const bool is_uniform = kind.has_uniform_stress;
  Plot plot;
  for (const auto& of : same)
    {
      const std::string beginning =
        same.size() > 1 || of.group.tests.size() > 1 || !of.counts_cracks() ? of.series->label : std::string();
      const auto label = [&](const std::string& ending) {
        return beginning.empty() ? ending : is_uniform ? beginning + ", " + ending : beginning;
      };
      add_stress_curve(
        plot, of, [](const CurveSample& row) { return row.axial_strain; }, false, 1.0, 1,
        label(is_uniform ? std::string("axial") : std::string(kind.channel.name)));
      if (!is_uniform)
        continue;
      const double peak = strain_at_peak(of.group);
      const double end = peak > 0.0 ? peak : 1.0;
      add_stress_curve(
        plot, of, [](const CurveSample& row) { return row.gauge_lateral_strain; }, true, end, 2, label("lateral"));
      add_stress_curve(
        plot, of, [](const CurveSample& row) { return row.gauge_volumetric_strain; }, true, end, 4,
        label("volumetric"));
    }
  if (plot.empty())
    return std::nullopt;
  const bool pulls = kind.sign > 0.0;
  const Chart axes{
    .x_label = is_uniform ? (pulls ? "strain [10⁻³], extension positive" : "strain [10⁻³], shortening positive")
                          : fmt::format("{} [10⁻³]", kind.channel.strain_name),
    .y_label = is_uniform ? fmt::format("{} [MPa], {} positive", kind.channel.name, pulls ? "tension" : "compression")
                          : fmt::format("{} [MPa]", kind.channel.name)};
  const std::string what = is_uniform
                             ? std::string("Stress against axial, lateral and volumetric strain")
                             : fmt::format("{} against {}", with_capital(kind.channel.name), kind.channel.strain_name);
  return Picture{
    .name = name + "_stress",
    .caption = what + (kind.follows_stages ? "" : means_and_bands(any_has_several(same))) +
               (is_uniform ? ". Lateral and volumetric strain up to the mean strain at peak" : ""),
    .alternative = what + " in " + of_tests + ".",
    .width = width,
    .height = plot.height(is_uniform ? 3 : 2),
    .script = plot.script(axes, fmt::format("set xzeroaxis; set yzeroaxis lw 0.8 lc rgb '#b0b0b0'\nset yrange [0:*]\n"
                                            "set key maxcols {}\n",
                                            is_uniform ? 3 : 2)),
    .live = plot.json(axes)};
}

/// Mean of a quantity over the tests of a group, over axial strain.
void add_mean(Plot& plot, const SeriesGroup& of, const Quantity& quantity, const std::string& of_colour,
              const int dashes, const std::string& label)
{
  const Band over_seeds = band(of.group, quantity, false);
  Points mean;
  Points around;
  Points back;
  for (std::size_t k = 0; k < over_seeds.abscissa.size(); ++k)
    {
      const double x = over_seeds.abscissa[k] / milli;
      mean.push_back({x, over_seeds.mean[k]});
      around.push_back({x, over_seeds.mean[k] + over_seeds.deviation[k]});
      back.push_back({x, over_seeds.mean[k] - over_seeds.deviation[k]});
    }
  around.insert(around.end(), back.rbegin(), back.rend());
  if (of.group.tests.size() > 1)
    plot.add(0, {.kind = Plot::Kind::area,
                 .label = label + ", ± standard deviation",
                 .goes_with = label,
                 .colour = of_colour,
                 .points = std::move(around)});
  plot.add(2, {.label = label, .colour = of_colour, .dashes = dashes, .points = std::move(mean)});
}

/// Of what the quantities of a test are followed along, and of its axis.
std::string abscissa_name(const SameTests& same)
{
  const TestKind& kind = same.front().group.kind;
  return kind.follows_stages ? "time" : std::string(kind.channel.strain_name);
}

std::string abscissa_label(const SameTests& same)
{
  return abscissa_name(same) + (same.front().group.kind.follows_stages ? " [ms]" : " [10⁻³]");
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
                 .width = width,
                 .height = plot.height(2),
                 .script = plot.script(axes, "set yrange [0:*]\nset key maxcols 2\n"),
                 .live = plot.json(axes)};
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
                                    Part{"strain energy", &Energies::strain, indigo, 1},
                                    Part{"damping", &Energies::damping, teal, 4},
                                    Part{"friction", &Energies::slip, olive, 2},
                                    Part{"released by breaks", &Energies::released, wine, 1},
                                    Part{"stress redistribution", &Energies::redistribution, sand, 2},
                                    Part{"kinetic", &Energies::kinetic, rose, 3}};
  Plot plot;
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
                 .width = width,
                 .height = plot.height(3),
                 .script = plot.script(axes, "set yrange [0:*]\nset key maxcols 3\n"),
                 .live = plot.json(axes)};
}

/// Cracks and their released energy per strain, as acoustic emission is shown.
std::optional<Picture> crack_rate_picture(const SameTests& same, const std::string& name, const std::string& of_tests)
{
  if (same.front().group.kind.follows_stages) // cracks have their strain, which goes back and forth
    return std::nullopt;
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
      Points rate;
      Points power;
      for (std::size_t k = 0; k < n_bins; ++k)
        {
          const double x = (double(k) + 0.5) * bin / milli;
          rate.push_back({x, hits[k] / n_tests / (bin / milli)});
          power.push_back({x, energy[k] / n_tests / (bin / milli)});
        }
      const std::string beginning = one ? "" : of.series->label + ", ";
      const std::string series_colour = colour(*of.series, of.n);
      plot.add(1, {.kind = Plot::Kind::steps,
                   .label = beginning + "cracks",
                   .colour = series_colour,
                   .width = 2.0,
                   .points = std::move(rate)});
      plot.add(2, {.kind = Plot::Kind::steps,
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
               std::string(any_has_several(same) ? "; mean of the tests" : ""),
    .alternative = fmt::format("Histogram of cracks and of the energy they released over {} in {}.",
                               same.front().group.kind.channel.strain_name, of_tests),
    .width = width,
    .height = plot.height(2),
    .script =
      plot.script(axes, fmt::format("set y2label {}\nset border 11\nset y2tics nomirror out\n"
                                    "set xrange [0:*]; set yrange [0:*]; set y2range [0:*]\nset key maxcols 2\n",
                                    gnuplot_text(axes.right_label))),
    .live = plot.json(axes)};
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

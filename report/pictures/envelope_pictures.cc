#include "report/pictures/envelope_pictures.h"

#include "report/live/chart.h"
#include "report/pictures/plot_style.h"
#include "results/fits/residual_strength.h"
#include "results/runs/test_groups.h"
#include "results/statistics.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <iterator>

namespace feldspar
{
namespace
{
using namespace plot;

/// A strength of a series with its scatter; a tension test lies at (-sigma_t, 0) and scatters along sigma_3.
struct StrengthPoint
{
  double sigma_3;
  double sigma_1;
  double deviation;
  bool tension;
};

std::vector<StrengthPoint> strength_points(const Series& series)
{
  std::vector<StrengthPoint> points;
  for (const auto& group : groups_of(series))
    if (const auto strength = statistics(values(group, &TestResults::peak_stress)))
      {
        const double deviation = strength->standard_deviation.value_or(0.0);
        switch (group.envelope_role())
          {
          case EnvelopeRole::tension:
          case EnvelopeRole::indirect_tension:
            points.push_back({-strength->mean, 0.0, deviation, true});
            break;
          case EnvelopeRole::compression:
            points.push_back({group.confining_pressure, strength->mean, deviation, false});
            break;
          case EnvelopeRole::none:
            break;
          }
      }
  return points;
}

struct CurveLooks
{
  double width;
  int dashes;
  std::string colour;
};

/// The curves of a picture and their range.
class EnvelopePlot
{
public:
  void take_in(const double sigma_3, const double sigma_1)
  {
    lowest_3 = std::min(lowest_3, sigma_3);
    highest_3 = std::max(highest_3, sigma_3);
    highest_1 = std::max(highest_1, sigma_1);
  }

  void add_points(const Series& series, const std::size_t n)
  {
    const auto points = strength_points(series);
    if (points.empty())
      return;
    const bool has_scatter =
      std::any_of(points.begin(), points.end(), [](const auto& one) { return one.deviation > 0.0; });
    const std::string label = series.label + (has_scatter ? ": mean ± s.d." : "");
    bool is_second = false;
    for (const bool tension : {false, true})
      {
        std::string rows;
        ChartLine marks{.kind = ChartLine::Kind::marks,
                        .label = label,
                        .goes_with = is_second ? label : "",
                        .colour = colour(series, n),
                        .mark = point_type(series)};
        ChartLine bars{.kind = ChartLine::Kind::bars,
                       .label = label,
                       .goes_with = label,
                       .colour = colour(series, n),
                       .width = 1.4};
        for (const auto& point : points)
          if (point.tension == tension)
            {
              fmt::format_to(std::back_inserter(rows), "{} {} {}\n", point.sigma_3 / mega, point.sigma_1 / mega,
                             point.deviation / mega);
              marks.points.push_back({point.sigma_3 / mega, point.sigma_1 / mega});
              for (const double sign : {-1.0, 1.0})
                bars.points.push_back({(point.sigma_3 + (tension ? sign * point.deviation : 0.0)) / mega,
                                       (point.sigma_1 + (tension ? 0.0 : sign * point.deviation)) / mega});
              bars.points.push_back(gap);
              take_in(point.sigma_3 - (tension ? point.deviation : 0.0),
                      point.sigma_1 + (tension ? 0.0 : point.deviation));
            }
        if (rows.empty())
          continue;
        const std::string block = add_data(rows);
        const std::string looks = fmt::format("pt {} ps 0.8 lw 1.4 lc rgb '{}'", marks.mark, marks.colour);
        later.push_back(fmt::format("{} using 1:2:3 with {} {} {}", block, tension ? "xerrorbars" : "yerrorbars", looks,
                                    key.entry(is_second ? "" : label)));
        of_page.push_back(std::move(bars));
        of_page.push_back(std::move(marks));
        is_second = true;
      }
  }

  /// The residual strengths: marks of the same form, open, along a thin line.
  void add_residual(const Series& series, const std::size_t n)
  {
    const std::string label = series.label + ": residual";
    ChartLine line{.label = label, .colour = colour(series, n), .width = 1.2, .dashes = 3};
    std::string rows;
    for (const auto& point : residual_points(series))
      {
        fmt::format_to(std::back_inserter(rows), "{} {} {}\n", point.sigma_3 / mega, point.sigma_1 / mega,
                       point.deviation / mega);
        line.points.push_back({point.sigma_3 / mega, point.sigma_1 / mega});
        take_in(point.sigma_3, point.sigma_1 + point.deviation);
      }
    if (rows.empty())
      return;
    ChartLine marks = line;
    marks.kind = ChartLine::Kind::marks;
    marks.goes_with = label;
    marks.mark = point_type(series) - 1;
    const std::string block = add_data(rows);
    first.push_back(fmt::format("{} using 1:2 with lines lw 1.2 dt 3 lc rgb '{}' notitle", block, line.colour));
    later.push_back(fmt::format("{} using 1:2:3 with yerrorbars pt {} ps 0.8 lw 1.2 lc rgb '{}' {}", block, marks.mark,
                                line.colour, key.entry(label)));
    of_page.push_back(std::move(line));
    of_page.push_back(std::move(marks));
  }

  /// Between two confinements.
  void add_curve(const std::function<double(double)>& sigma_1, const double begin, const double end,
                 const CurveLooks& looks, const std::string& label)
  {
    std::string rows;
    ChartLine line{.label = label, .colour = looks.colour, .width = looks.width, .dashes = looks.dashes};
    constexpr int n = 300;
    for (int k = 0; k <= n; ++k)
      {
        // Closer where the curve bends: near its beginning.
        const double share = std::pow(double(k) / n, 4.0);
        const double inside = begin + 1e-12 * std::abs(begin); // at its beginning the bracket is 0, or just below it
        const double sigma_3 = inside + (end - inside) * share;
        if (const double value = sigma_1(sigma_3); std::isfinite(value))
          {
            fmt::format_to(std::back_inserter(rows), "{} {}\n", sigma_3 / mega, value / mega);
            if (k % 3 == 0)
              line.points.push_back({sigma_3 / mega, value / mega});
          }
      }
    first.push_back(fmt::format("{} using 1:2 with lines lw {} dt {} lc rgb '{}' {}", add_data(rows), looks.width,
                                looks.dashes, looks.colour, key.entry(label)));
    of_page.push_back(std::move(line));
  }

  /// As far as its points go, beyond which nothing is known of it.
  template <typename Fit>
  void add_fit(const Fit& fit, const CurveLooks& looks, const std::string& label)
  {
    add_curve([&](const double x) { return fit.sigma_1(x); }, fit.quality.lowest_sigma_3(),
              fit.quality.highest_sigma_3(), looks, label);
  }

  void add_reference(const Reference& reference)
  {
    const std::string label = reference.experiment.label + ": mean, range";
    bool is_second = false;
    const auto draw_range = [&](const std::string& property, const bool tension) {
      const auto value = reference.experiment.find(property);
      if (!value)
        return;
      const double middle = value->middle();
      const double low = value->low.value_or(middle);
      const double high = value->high.value_or(middle);
      const std::string block = add_data(tension ? fmt::format("{} 0 {} {}\n", -middle, -high, -low)
                                                 : fmt::format("0 {} {} {}\n", middle, low, high));
      later.push_back(fmt::format("{} using 1:2:3:4 with {} pt {} ps 1.1 lw 2.2 lc rgb '{}' {}", block,
                                  tension ? "xerrorbars" : "yerrorbars", mark_of_experiment, black,
                                  key.entry(is_second ? "" : label)));
      const auto at = [&](const double strength) {
        return tension ? std::array{-strength, 0.0} : std::array{0.0, strength};
      };
      of_page.push_back({.kind = ChartLine::Kind::bars,
                         .label = label,
                         .goes_with = label,
                         .colour = black,
                         .points = {at(low), at(high), gap}});
      of_page.push_back({.kind = ChartLine::Kind::marks,
                         .label = label,
                         .goes_with = is_second ? label : "",
                         .colour = black,
                         .mark = mark_of_experiment,
                         .points = {at(middle)}});
      is_second = true;
      take_in(tension ? -high * mega : 0.0, tension ? 0.0 : high * mega);
    };
    draw_range("uniaxial_compressive_strength_MPa", false);
    draw_range("tensile_strength_MPa", true);
    draw_strengths(reference.experiment, mark_of_experiment, "ps 1.1 lw 1.6", black);
    draw_strengths(reference.model, mark_of_model, "ps 0.9 lw 1.2", grey);
  }

  /// What a source prints without its points, from its beginning to the end of the plot, which must be known.
  void add_printed(const ReferenceSource& source, const char* of_colour)
  {
    if (const auto& printed = source.envelope)
      add_curve([&](const double x) { return printed->sigma_1(x); }, -printed->s * printed->sigma_ci / printed->m,
                highest_3, {1.4, 3, of_colour}, source.label + ", printed");
    if (const auto line = source.line())
      add_curve([&](const double x) { return line->sigma_1(x); }, 0.0, highest_3, {1.4, 4, of_colour},
                source.label + ": c and φ, printed");
  }

  /// The curve through the points of the experiment.
  void add_fit_of(const ReferenceSource& experiment)
  {
    for (const auto& pair : experiment.fitted.hoek_brown)
      if (pair.form == HoekBrownForm::intact)
        {
          const auto& best = pair.with_tension_point.fit ? pair.with_tension_point.fit : pair.without_tension_point.fit;
          if (best && best->quality.degrees_of_freedom > 0)
            add_fit(
              *best, {1.6, 2, black},
              fmt::format("{}: H–B intact, {} σ_t", experiment.label, best->with_tension_point ? "with" : "without"));
        }
  }

  void add_rock_curves(const Reference& reference)
  {
    add_fit_of(reference.experiment);
    add_printed(reference.experiment, black);
    add_printed(reference.model, grey);
  }

  void add_cut_off(const double sigma_3, const std::string& of_colour)
  {
    const std::string block = add_data(fmt::format("{} 0\n{} {}\n", sigma_3 / mega, sigma_3 / mega, highest_1 / mega));
    const std::string label = "tensile cut-off of the intact form";
    first.push_back(
      fmt::format("{} using 1:2 with lines lw 1 dt 3 lc rgb '{}' {}", block, of_colour, key.entry(label)));
    of_page.push_back({.label = label,
                       .colour = of_colour,
                       .width = 1.0,
                       .dashes = 3,
                       .points = {{sigma_3 / mega, 0.0}, {sigma_3 / mega, highest_1 / mega}}});
  }

  /// The part up to these stresses, or all of it [Pa].
  std::string script(const std::optional<EnvelopePoint>& upper = std::nullopt) const
  {
    std::string text = data + frame(x_label, y_label);
    fmt::format_to(std::back_inserter(text), "set xrange [{}:{}]; set yrange [0:{}]\n",
                   (lowest_3 < 0.0 ? 1.25 * lowest_3 : 0.0) / mega,
                   (upper ? upper->sigma_3 : std::max(1.05 * highest_3, 1e6)) / mega,
                   (upper ? upper->sigma_1 : 1.08 * highest_1) / mega);
    text += "set arrow from 0, graph 0 to 0, graph 1 nohead lw 0.8 lc rgb '#b0b0b0' back\n" + key.set_up(width) +
            " font ',12'\nplot ";
    const auto add = [&](const std::vector<std::string>& entries) {
      for (const auto& entry : entries)
        text += entry + ", \\\n";
    };
    add(first);
    add(later);
    text.resize(text.size() - 4); // the last comma
    return text + "\n";
  }

  /// All of it: who looks closer enlarges it there.
  std::string json() const
  {
    Chart chart{.x_label = x_label, .y_label = y_label};
    chart.lines = of_page;
    return chart.json();
  }

  bool empty() const { return first.empty() && later.empty(); }

  /// Of the picture [px].
  int height() const { return 640 + key.further_height(width); }

  static constexpr int width = 660; ///< [px]
  double lowest_3 = 0.0;
  double highest_3 = 0.0;
  double highest_1 = 0.0;

private:
  static constexpr const char* x_label = "confinement σ₃ [MPa], compression positive";
  static constexpr const char* y_label = "strength σ₁ [MPa]";
  static constexpr int mark_of_experiment = 8; // open triangle
  static constexpr int mark_of_model = 4;      // open square

  void draw_strengths(const ReferenceSource& source, const int mark, const std::string& looks, const char* of_colour)
  {
    std::string rows;
    ChartLine marks{.kind = ChartLine::Kind::marks, .label = source.label, .colour = of_colour, .mark = mark};
    for (const auto& point : source.strengths())
      {
        fmt::format_to(std::back_inserter(rows), "{} {}\n", point.sigma_3 / mega, point.sigma_1 / mega);
        marks.points.push_back({point.sigma_3 / mega, point.sigma_1 / mega});
        take_in(point.sigma_3, point.sigma_1);
      }
    if (rows.empty())
      return;
    later.push_back(fmt::format("{} using 1:2 with points pt {} {} lc rgb '{}' {}", add_data(rows), mark, looks,
                                of_colour, key.entry(source.label)));
    of_page.push_back(std::move(marks));
  }

  std::string add_data(const std::string& rows)
  {
    const std::string block = fmt::format("$data{}", n_blocks++);
    data += fmt::format("{} << EOD\n{}EOD\n", block, rows);
    return block;
  }

  std::string data;
  std::vector<std::string> first; ///< curves
  std::vector<std::string> later; ///< points, drawn over them
  std::vector<ChartLine> of_page;
  ColumnKey key;
  int n_blocks = 0;
};

/// In the colour of their series: a form by its dashes, what leaves out the tension point thin.
void add_fits(EnvelopePlot& plotted, const StrengthEnvelopes& envelopes, const std::string& of_colour)
{
  for (const auto& pair : envelopes.hoek_brown)
    {
      // One curve in two parametrisations (docs/theory.md §6.1): drawn once.
      if (pair.form == HoekBrownForm::general && envelopes.hoek_brown.front().with_tension_point.fit)
        continue;
      const bool is_intact = pair.form == HoekBrownForm::intact;
      const std::string name = is_intact                              ? "H–B intact"
                               : pair.form == HoekBrownForm::as_paper ? "H–B as the paper = general"
                                                                      : "H–B general";
      for (const auto* either : {&pair.with_tension_point, &pair.without_tension_point})
        if (either->fit && either->fit->quality.degrees_of_freedom > 0)
          {
            const HoekBrownFit& fit = *either->fit;
            plotted.add_fit(fit, {fit.with_tension_point ? 2.4 : 1.1, is_intact ? 1 : 2, of_colour},
                            name + (fit.with_tension_point ? ", with σ_t" : ", without σ_t"));
            if (is_intact && fit.with_tension_point)
              plotted.add_cut_off(fit.tensile_cut_off.value, of_colour);
          }
    }
  if (const auto& fit = envelopes.mohr_coulomb.fit; fit && fit->quality.degrees_of_freedom > 0)
    plotted.add_fit(*fit, {1.8, 4, of_colour}, "Mohr–Coulomb");
}
} // namespace

std::vector<Picture> envelope_pictures(const std::vector<Series>& all, const std::size_t which,
                                       const StrengthEnvelopes& envelopes, const std::optional<Reference>& reference)
{
  EnvelopePlot plotted;
  plotted.add_points(all[which], which);
  plotted.add_residual(all[which], which);
  if (reference)
    plotted.add_reference(*reference);
  if (plotted.empty())
    return {};
  add_fits(plotted, envelopes, colour(all[which], which));
  if (reference)
    plotted.add_rock_curves(*reference);
  const std::string of_series = all.size() > 1 ? fmt::format("_{}", file_name(all[which].label)) : "";
  std::vector<Picture> pictures;
  pictures.push_back(
    {.name = "envelope" + of_series,
     .caption = "Strength envelope" + (all.size() > 1 ? " of " + all[which].label : std::string()),
     .alternative = "Strength against confinement: mean and standard deviation of the model's tests, the Hoek–Brown "
                    "forms, Mohr–Coulomb, and the reference. The figures are in the tables below.",
     .width = plotted.width,
     .height = plotted.height(),
     .script = plotted.script(),
     .live = plotted.json()});
  // Near the uniaxial test, where the forms differ.
  if (envelopes.data.uniaxial_compressive_strength && plotted.highest_3 > 0.0)
    {
      const double sigma_3 = 0.2 * plotted.highest_3;
      pictures.push_back(
        {.name = "envelope_near_uniaxial" + of_series,
         .caption = "The same near the uniaxial and the tension test",
         .alternative = "The strength envelope between tension and low confinement, enlarged.",
         .width = plotted.width,
         .height = plotted.height(),
         .script = plotted.script(EnvelopePoint{sigma_3, 2.2 * *envelopes.data.uniaxial_compressive_strength})});
    }
  return pictures;
}

std::vector<Picture> combined_envelope_picture(const std::vector<Series>& all,
                                               const std::vector<StrengthEnvelopes>& envelopes,
                                               const std::optional<Reference>& reference)
{
  if (all.size() < 2)
    return {};
  EnvelopePlot plotted;
  for (std::size_t n = 0; n < all.size(); ++n)
    {
      plotted.add_points(all[n], n);
      plotted.add_residual(all[n], n);
    }
  if (reference)
    plotted.add_reference(*reference);
  if (!(plotted.highest_1 > 0.0)) // tension alone
    return {};
  for (std::size_t n = 0; n < all.size(); ++n)
    for (const auto& pair : envelopes[n].hoek_brown)
      if (const auto& fit = pair.with_tension_point.fit;
          pair.form == HoekBrownForm::intact && fit && fit->quality.degrees_of_freedom > 0)
        plotted.add_fit(*fit, {2.0, dashes(n), colour(all[n], n)}, all[n].label + ": H–B intact, with σ_t");
  if (reference)
    plotted.add_fit_of(reference->experiment);
  return {{.name = "envelopes",
           .caption = "Strength of all series",
           .alternative = "Strength against confinement of all series, each with the intact Hoek–Brown envelope.",
           .width = plotted.width,
           .height = plotted.height(),
           .script = plotted.script(),
           .live = plotted.json()}};
}

std::vector<Picture> residual_picture(const Series& series, const std::size_t which, const StrengthEnvelopes& envelopes)
{
  const std::string of_colour = colour(series, which);
  std::string data;
  std::string plots;
  int n = 0;
  const auto add = [&](const FitQuality& quality, const std::string& label, const std::string& looks) {
    fmt::format_to(std::back_inserter(data), "$fit{} << EOD\n", n);
    for (const auto& [point, residual] : quality.residuals)
      fmt::format_to(std::back_inserter(data), "{} {}\n", point.sigma_3 / mega, residual / mega);
    data += "EOD\n";
    plots += fmt::format("{}$fit{} using 1:2 with linespoints {} {}", n ? ", \\\n" : "", n, looks, title(label));
    ++n;
  };
  for (const auto& pair : envelopes.hoek_brown)
    {
      if (pair.form == HoekBrownForm::general && envelopes.hoek_brown.front().with_tension_point.fit)
        continue;
      const bool is_intact = pair.form == HoekBrownForm::intact;
      for (const auto* either : {&pair.with_tension_point, &pair.without_tension_point})
        if (either->fit && either->fit->quality.degrees_of_freedom > 0)
          add(either->fit->quality,
              fmt::format("{}, {} σ_t", is_intact ? "intact" : "as the paper = general",
                          either->fit->with_tension_point ? "with" : "without"),
              fmt::format("lw {} dt {} pt {} ps 0.7 lc rgb '{}'", either->fit->with_tension_point ? 2.4 : 1.1,
                          is_intact ? 1 : 2, is_intact ? 7 : 5, of_colour));
    }
  if (const auto& fit = envelopes.mohr_coulomb.fit; fit && fit->quality.degrees_of_freedom > 0)
    add(fit->quality, "Mohr–Coulomb", fmt::format("lw 1.6 dt 4 pt 9 ps 0.7 lc rgb '{}'", of_colour));
  if (n == 0)
    return {};
  return {
    {.name = "residuals_" + file_name(series.label),
     .caption = "Residuals: strength of each point less that of the envelope",
     .alternative = "Residual of each point for each fitted envelope; the figures are in the table below.",
     .width = 660,
     .height = 460,
     .script =
       data + frame("confinement σ₃ [MPa], compression positive", "residual in σ₁ [MPa]") +
       "set xzeroaxis lw 1 lc rgb '#808080'\nset key vertical maxrows 3 font ',12'\nset offsets graph 0.03, graph 0.03, graph 0.05, graph 0.05\nplot " +
       plots + "\n"}};
}

std::vector<Picture> shear_share_picture(const std::vector<Series>& all)
{
  std::string data;
  std::string plots;
  for (std::size_t n = 0; n < all.size(); ++n)
    {
      std::string rows;
      for (const auto& group : groups_of(all[n]))
        if (group.envelope_role() == EnvelopeRole::compression)
          if (const auto share = statistics(values(group, &TestResults::shear_share_at_peak)))
            fmt::format_to(std::back_inserter(rows), "{} {} {}\n", group.confining_pressure / mega,
                           share->mean / percent, share->standard_deviation.value_or(0.0) / percent);
      if (rows.empty())
        continue;
      fmt::format_to(std::back_inserter(data), "$share{} << EOD\n{}EOD\n", n, rows);
      fmt::format_to(std::back_inserter(plots),
                     "{}$share{} using 1:2:3 with yerrorlines pt 7 ps 0.7 lw 1.6 dt {} lc rgb '{}' {}",
                     plots.empty() ? "" : ", ", n, dashes(n), colour(all[n], n), title(all[n].label + ": mean ± s.d."));
    }
  if (plots.empty())
    return {};
  return {{.name = "shear_share",
           .caption = "Share of shear cracks at the peak against confinement",
           .alternative = "Share of shear cracks among all cracks at the peak, against confinement.",
           .width = 640,
           .height = 420,
           .script = data + frame("confinement σ₃ [MPa]", "shear cracks at the peak [%]") +
                     "set offsets 0, graph 0.03, graph 0.03, 0\nset yrange [0:*]\nplot " + plots + "\n"}};
}
} // namespace feldspar

#include "base/append.h"
#include "report/pictures/envelope_curves.h"
#include "report/pictures/figures.h"
#include "report/pictures/plot_style.h"
#include "results/fits/residual_strength.h"
#include "results/runs/test_groups.h"
#include "results/statistics.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <utility>

namespace feldspar
{
namespace
{
using namespace plot;
using Kind = ChartSeries::Kind;
using Bars = ChartSeries::Bars;

/// Strengths with their scatter [MPa], in compression and in tension. A tension test lies at (-sigma_t, 0) and scatters along
/// sigma_3.
std::array<std::vector<ChartPoint>, 2> strength_points(const Series& series)
{
  std::array<std::vector<ChartPoint>, 2> points;
  for (const auto& group : groups_of(series))
    if (const auto strength = statistics(values(group, &TestResults::peak_stress)))
      {
        const double mean = strength->mean / mega;
        const double deviation = strength->standard_deviation.value_or(0.0) / mega;
        const EnvelopeRole role = group.envelope_role();
        if (role == EnvelopeRole::tension || role == EnvelopeRole::indirect_tension)
          points[1].push_back({-mean, 0.0, -mean - deviation, -mean + deviation});
        else if (role == EnvelopeRole::compression)
          points[0].push_back({group.confining_pressure / mega, mean, mean - deviation, mean + deviation});
      }
  return points;
}

/// A picture of strengths over confinement in the making [MPa].
struct EnvelopePlot
{
  std::vector<ChartSeries> curves;
  std::vector<ChartSeries> points; ///< drawn over the curves; the picture reaches as far as they do

  void add_points(const Series& series, const std::size_t n)
  {
    std::string label = series.key();
    auto points_of_both = strength_points(series);
    auto& [pressed, pulled] = points_of_both;
    const auto scatters = [](const ChartPoint& point) { return point[2] < point[3]; };
    if (std::ranges::any_of(pressed, scatters) || std::ranges::any_of(pulled, scatters))
      label += ": mean ± s.d.";
    ChartSeries marks{.kind = Kind::marks,
                      .label = label,
                      .colour = colour(series, n),
                      .bars = Bars::along_y,
                      .width = 1.4,
                      .mark = point_type(series),
                      .points = pressed};
    points.push_back(marks);
    marks.bars = Bars::along_x;
    marks.points = pulled;
    if (!pressed.empty())
      marks.goes_with = label;
    points.push_back(std::move(marks));
  }

  /// The residual strengths: marks of the same form, open, along a thin line.
  void add_residual(const Series& series, const std::size_t n)
  {
    ChartSeries line{.label = series.key() + ": residual", .colour = colour(series, n), .width = 1.2, .dashes = 3};
    for (const auto& point : residual_points(series))
      line.points.push_back({point.sigma_3 / mega, point.sigma_1 / mega, (point.sigma_1 - point.deviation) / mega,
                             (point.sigma_1 + point.deviation) / mega});
    ChartSeries marks = line;
    marks.kind = Kind::marks;
    marks.bars = Bars::along_y;
    marks.mark = point_type(series) - 1;
    line.goes_with = line.label;
    curves.push_back(std::move(line));
    points.push_back(std::move(marks));
  }

  /// Adds a curve between two confinements [Pa].
  void add_curve(const std::function<double(double)>& sigma_1, const double begin, const double end, ChartSeries looks)
  {
    // The bracket is 0, or just below it, at the beginning of the curve.
    for (const double sigma_3 : abscissas(begin + 1e-12 * std::abs(begin), end))
      if (const double value = sigma_1(sigma_3); std::isfinite(value))
        looks.points.push_back({sigma_3 / mega, value / mega});
    curves.push_back(std::move(looks));
  }

  void add_reference(const Reference& reference)
  {
    constexpr int open_triangle = 8;
    constexpr int open_square = 4;
    const ReferenceSource& experiment = reference.experiment;
    ChartSeries range{.kind = Kind::marks,
                      .label = experiment.label + ": mean, range",
                      .colour = black,
                      .mark = open_triangle,
                      .size = 1.1};
    for (const bool tension : {false, true})
      if (const auto value = experiment.find(tension ? "tensile_strength_MPa" : "uniaxial_compressive_strength_MPa"))
        {
          const double middle = value->middle();
          const double low = value->low.value_or(middle);
          const double high = value->high.value_or(middle);
          range.bars = tension ? Bars::along_x : Bars::along_y;
          range.points = {tension ? ChartPoint{-middle, 0.0, -high, -low} : ChartPoint{0.0, middle, low, high}};
          points.push_back(range);
          range.goes_with = range.label;
        }
    add_strengths(experiment,
                  {.label = experiment.label, .colour = black, .width = 1.6, .mark = open_triangle, .size = 1.1});
    add_strengths(reference.model,
                  {.label = reference.model.label, .colour = grey, .width = 1.2, .mark = open_square, .size = 0.9});
  }

  /// The parameters that a source prints, from its beginning to the largest σ₃ of the source's points; to the end of the
  /// plot, which must be known, where it has none under confinement.
  void add_printed(const ReferenceSource& source, const char* const of_colour)
  {
    const auto strengths = source.strengths(); // by rising pressure
    const double end =
      !strengths.empty() && strengths.back().sigma_3 > 0.0 ? strengths.back().sigma_3 : limits().high[0] * mega;
    ChartSeries looks{.label = source.label + ", printed", .colour = of_colour, .width = 1.4, .dashes = 3};
    if (const auto& printed = source.envelope)
      add_curve([&](const double x) { return printed->sigma_1(x); }, -printed->s * printed->sigma_ci / printed->m, end,
                looks);
    looks.label = source.label + ": c and φ, printed";
    looks.dashes = 4;
    if (const auto line = source.line())
      add_curve([&](const double x) { return line->sigma_1(x); }, 0.0, end, looks);
  }

  /// Adds a fit as far as its points go; beyond them nothing is known of it.
  template <typename Fit>
  void add_fit(const Fit& fit, ChartSeries looks)
  {
    add_curve([&](const double x) { return fit.sigma_1(x); }, fit.quality.lowest_sigma_3(),
              fit.quality.highest_sigma_3(), std::move(looks));
  }

  /// The curve through the points of the experiment.
  void add_fit_of(const ReferenceSource& experiment)
  {
    const HoekBrownFit* const with_tension = experiment.fitted.fit(HoekBrownForm::intact, true);
    const HoekBrownFit* const best = with_tension ? with_tension : experiment.fitted.fit(HoekBrownForm::intact, false);
    if (best && best->quality.degrees_of_freedom > 0)
      add_fit(*best, {.label = experiment.label + ": " + label_of(*best), .colour = black, .width = 1.6, .dashes = 2});
  }

  /// The origin and the points, with the lower ends of bars along σ₃ and the upper ends of those along σ₁.
  Limits<2> limits() const
  {
    Limits<2> limits;
    limits.include({0.0, 0.0});
    for (const ChartSeries& series : points)
      for (const auto& [x, y, low, high] : series.points)
        {
          limits.include({x, series.bars == Bars::along_y ? high : y});
          if (series.bars == Bars::along_x)
            limits.include({low, y});
        }
    return limits;
  }

  /// The part up to these stresses, or all of it.
  Chart chart(const std::optional<EnvelopePoint>& upper = std::nullopt) const
  {
    const auto [low, high] = limits();
    Chart chart{.x = {.label = "confinement σ₃ [MPa], compression positive",
                      .from = 1.25 * low[0],
                      .to = upper ? upper->sigma_3 / mega : std::max(1.05 * high[0], 1.0)},
                .y = {.label = "strength σ₁ [MPa]", .from = 0.0, .to = upper ? upper->sigma_1 / mega : 1.08 * high[1]},
                .series = curves};
    chart.series.insert(chart.series.end(), points.begin(), points.end());
    return chart;
  }

  void add_strengths(const ReferenceSource& source, ChartSeries marks)
  {
    marks.kind = Kind::marks;
    for (const auto& point : source.strengths())
      marks.points.push_back({point.sigma_3 / mega, point.sigma_1 / mega});
    points.push_back(std::move(marks));
  }
};

/// A fitted form with what tells it apart: a form by its dashes, what leaves out the tension point is thin.
struct DrawnFit
{
  const HoekBrownFit* fit;
  std::string label;
  double width;
  int dashes;
  bool is_intact;
};

/// Fits with more points than parameters.
std::vector<DrawnFit> drawn_fits(const StrengthEnvelopes& envelopes)
{
  std::vector<DrawnFit> fits;
  for (const auto& [form, with_tension, answer] : envelopes.hoek_brown)
    {
      // One curve in two parametrisations (docs/theory.md §6.1): drawn once.
      if (form == HoekBrownForm::regressed ||
          (form == HoekBrownForm::general && envelopes.fit(HoekBrownForm::as_paper, true)))
        continue;
      const bool is_intact = form == HoekBrownForm::intact;
      if (answer.fit && answer.fit->quality.degrees_of_freedom > 0)
        fits.push_back({&*answer.fit,
                        fmt::format("{}, {} σ_t", title(is_intact ? form : HoekBrownForm::general),
                                    *with_tension ? "with" : "without"),
                        *with_tension ? 2.4 : 1.1, is_intact ? 1 : 2, is_intact});
    }
  return fits;
}

/// Adds the fits in the colour of their series.
void add_fits(EnvelopePlot& plotted, const StrengthEnvelopes& envelopes, const std::string& of_colour)
{
  for (const auto& [fit, label, width, its_dashes, is_intact] : drawn_fits(envelopes))
    {
      plotted.add_fit(*fit, {.label = "H–B " + label, .colour = of_colour, .width = width, .dashes = its_dashes});
      if (!is_intact || !fit->with_tension_point)
        continue;
      const double sigma_3 = fit->tensile_cut_off.value / mega;
      plotted.curves.push_back(
        {.label = "tensile cut-off of the intact form",
         .colour = of_colour,
         .width = 1.0,
         .dashes = 3,
         .points = {{sigma_3, 0.0}, {sigma_3, fit->uniaxial_compressive_strength.value / mega}}});
    }
  if (const auto& fit = envelopes.mohr_coulomb.fit; fit && fit->quality.degrees_of_freedom > 0)
    plotted.add_fit(*fit, {.label = "Mohr–Coulomb", .colour = of_colour, .width = 1.8, .dashes = 4});
}
} // namespace

std::string label_of(const HoekBrownFit& fit)
{
  return fmt::format("H–B {}, {} σ_t", title(fit.form), fit.with_tension_point ? "with" : "without");
}

std::vector<double> abscissas(const double begin, const double end)
{
  constexpr int n = 150;
  std::vector<double> result;
  for (int k = 0; k <= n; ++k)
    result.push_back(begin + (end - begin) * std::pow(double(k) / n, 4.0));
  return result;
}

Pictures envelope_pictures(const SeriesAmong& of)
{
  const StrengthEnvelopes& envelopes = of.envelopes;
  EnvelopePlot plotted;
  plotted.add_points(of.series(), of.n);
  plotted.add_residual(of.series(), of.n);
  if (of.reference)
    plotted.add_reference(*of.reference);
  if (plotted.chart().empty())
    return {};
  add_fits(plotted, envelopes, colour(of.series(), of.n));
  if (of.reference)
    {
      plotted.add_fit_of(of.reference->experiment);
      plotted.add_printed(of.reference->experiment, black);
      plotted.add_printed(of.reference->model, grey);
    }
  const bool is_one_of_many = of.all.size() > 1;
  const std::string ending = is_one_of_many ? "_" + file_name(of.series().label) : "";
  Pictures pictures = picture_of(
    plotted.chart(), 660, 640, "envelope" + ending,
    std::string(envelopes.data.of_flawed_body ? "Envelope of highest nominal stresses" : "Strength envelope") +
      (is_one_of_many ? " of " + of.series().label : ""),
    "Strength against confinement: mean and standard deviation of the model's tests, the Hoek–Brown "
    "forms, Mohr–Coulomb, and the reference. The figures are in the tables below.");
  // A picture near the uniaxial test, where the forms differ.
  if (const double highest_3 = plotted.limits().high[0];
      envelopes.data.uniaxial_compressive_strength && highest_3 > 0.0)
    append(pictures,
           picture_of(
             plotted.chart(EnvelopePoint{0.2 * highest_3 * mega, 2.2 * *envelopes.data.uniaxial_compressive_strength}),
             660, 640, "envelope_near_uniaxial" + ending, "The same near the uniaxial and the tension test",
             "The strength envelope between tension and low confinement, enlarged."));
  return pictures;
}

Pictures combined_envelope_picture(const AllSeries& of)
{
  EnvelopePlot plotted;
  for (std::size_t n = 0; n < of.all.size(); ++n)
    {
      plotted.add_points(of.all[n], n);
      plotted.add_residual(of.all[n], n);
    }
  if (of.reference)
    plotted.add_reference(*of.reference);
  if (!(plotted.limits().high[1] > 0.0)) // tension alone
    return {};
  for (std::size_t n = 0; n < of.all.size(); ++n)
    if (const HoekBrownFit* const fit = of.envelopes[n].representative())
      plotted.add_fit(*fit, {.label = of.all[n].label + ": " + label_of(*fit),
                             .colour = colour(of.all[n], n),
                             .width = 2.0,
                             .dashes = dashes(n)});
  if (of.reference)
    plotted.add_fit_of(of.reference->experiment);
  return picture_of(plotted.chart(), 660, 640, "envelopes",
                    of.all.size() > 1 ? "Strength of all series" : "Strength against confinement, with one envelope",
                    "Strength against confinement of each series with its Hoek–Brown envelope.");
}

Pictures residual_picture(const SeriesAmong& of)
{
  Chart chart{.x = {.label = "confinement σ₃ [MPa], compression positive", .room = 0.03},
              .y = {.label = "residual in σ₁ [MPa]", .room = 0.05},
              .key_columns = 2};
  const auto add = [&](const FitQuality& quality, ChartSeries looks) {
    looks.kind = Kind::marked_line;
    looks.colour = colour(of.series(), of.n);
    looks.size = 0.7;
    for (const auto& [point, residual] : quality.residuals)
      looks.points.push_back({point.sigma_3 / mega, residual / mega});
    chart.series.push_back(std::move(looks));
  };
  for (const auto& [fit, label, width, its_dashes, is_intact] : drawn_fits(of.envelopes))
    add(fit->quality, {.label = label, .width = width, .dashes = its_dashes, .mark = is_intact ? 7 : 5});
  if (const auto& fit = of.envelopes.mohr_coulomb.fit; fit && fit->quality.degrees_of_freedom > 0)
    add(fit->quality, {.label = "Mohr–Coulomb", .width = 1.6, .dashes = 4, .mark = 9});
  if (chart.empty())
    return {};
  return {{.name = "residuals_" + file_name(of.series().label),
           .caption = "Residuals: strength of each point less that of the envelope",
           .alternative = "Residual of each point for each fitted envelope; the figures are in the table below.",
           .width = 660,
           .height = 460,
           .panels = {std::move(chart)}}};
}

Pictures shear_share_picture(const AllSeries& of)
{
  Chart chart{.x = {.label = "confinement σ₃ [MPa]"},
              .y = {.label = "shear cracks at the peak [%]", .from = 0.0},
              .key_columns = 2};
  for (std::size_t n = 0; n < of.all.size(); ++n)
    {
      ChartSeries line{.kind = Kind::marked_line,
                       .label = of.all[n].label + ": mean ± s.d.",
                       .colour = colour(of.all[n], n),
                       .bars = Bars::along_y,
                       .width = 1.6,
                       .dashes = dashes(n),
                       .size = 0.7};
      for (const auto& group : groups_of(of.all[n]))
        if (group.envelope_role() == EnvelopeRole::compression)
          if (const auto share = statistics(values(group, &TestResults::shear_share_at_peak)))
            {
              const double mean = share->mean / percent;
              const double deviation = share->standard_deviation.value_or(0.0) / percent;
              line.points.push_back({group.confining_pressure / mega, mean, mean - deviation, mean + deviation});
            }
      chart.series.push_back(std::move(line));
    }
  if (chart.empty())
    return {};
  return {{.name = "shear_share",
           .caption = "Share of shear cracks at the peak against confinement",
           .alternative = "Share of shear cracks among all cracks at the peak, against confinement.",
           .width = 640,
           .height = 420,
           .panels = {std::move(chart)}}};
}
} // namespace feldspar

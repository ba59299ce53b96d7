#include "report/pictures/envelope_curves.h"
#include "report/pictures/figures.h"
#include "report/pictures/plot_style.h"
#include "results/fits/residual_strength.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>

namespace feldspar
{
namespace
{
using namespace plot;

void add_circle(Chart& chart, const double sigma_3, const double sigma_1, ChartSeries looks)
{
  constexpr int n_points = 90;
  for (int k = 0; k <= n_points; ++k)
    {
      const double angle = std::numbers::pi * (1.0 - double(k) / n_points);
      looks.points.push_back({(0.5 * (sigma_1 + sigma_3) + 0.5 * (sigma_1 - sigma_3) * std::cos(angle)) / mega,
                              0.5 * (sigma_1 - sigma_3) * std::sin(angle) / mega});
    }
  chart.series.push_back(std::move(looks));
}

/// The envelope of the circles of these states.
template <typename Fit>
void add_envelope(Chart& chart, const Fit& fit, const std::vector<double>& all_sigma_3, ChartSeries looks)
{
  for (const double sigma_3 : all_sigma_3)
    {
      const auto [normal, shear] = touching_point([&](const double x) { return fit.sigma_1(x); }, sigma_3);
      if (std::isfinite(normal) && std::isfinite(shear))
        looks.points.push_back({normal / mega, shear / mega});
    }
  chart.series.push_back(std::move(looks));
}
} // namespace

PlaneStress touching_point(const std::function<double(double)>& sigma_1, const double sigma_3)
{
  const double step = std::max(1.0, 1e-6 * std::abs(sigma_3)); // [Pa]
  const double slope = (sigma_1(sigma_3 + step) - sigma_1(sigma_3)) / step;
  const double normal = sigma_3 + (sigma_1(sigma_3) - sigma_3) / (slope + 1.0);
  return {normal, (normal - sigma_3) * std::sqrt(slope)};
}

Pictures mohr_picture(const SeriesAmong& of)
{
  const StrengthData& data = of.envelopes.data;
  if (data.points.size() + (data.tensile_strength ? 1 : 0) < 2)
    return {};
  const std::string of_colour = colour(of.series(), of.n);
  std::vector<EnvelopePoint> strengths = data.points;
  if (data.tensile_strength)
    strengths.push_back({-*data.tensile_strength, 0.0});
  Limits<2> limits;
  limits.include({0.0, 0.0});
  for (const auto& [sigma_3, sigma_1] : strengths)
    limits.include({sigma_3 / mega, sigma_1 / mega});
  const double reach = 1.03 * limits.high[1];
  Chart chart{.x = {.label = "normal stress σ_n [MPa], compression positive", .from = 1.1 * limits.low[0], .to = reach},
              .y = {.label = "shear stress τ [MPa]", .from = 0.0, .to = 0.56 * reach},
              .equal_scales = true,
              .key_columns = 3};
  const auto add_circles = [&](const auto& states, ChartSeries looks) {
    const std::string leader = looks.label;
    for (const auto& state : states)
      {
        add_circle(chart, state.sigma_3, state.sigma_1, looks);
        looks.goes_with = leader;
      }
  };
  add_circles(strengths, {.label = "strengths, means", .colour = of_colour, .width = 1.2});
  const auto residual = residual_points(of.series());
  add_circles(residual, {.label = "residual strengths, means", .colour = of_colour, .width = 1.0, .dashes = 3});
  if (const HoekBrownFit* const fit = of.envelopes.representative())
    {
      const double begin = fit->quality.lowest_sigma_3(); // there the envelope may stand upright
      add_envelope(chart, *fit, abscissas(begin + 1e-9 * std::abs(begin), fit->quality.highest_sigma_3()),
                   {.label = label_of(*fit), .colour = of_colour, .width = 2.4});
    }
  if (const auto& fit = of.envelopes.mohr_coulomb.fit; fit && fit->quality.degrees_of_freedom > 0)
    add_envelope(chart, *fit, {fit->quality.lowest_sigma_3(), fit->quality.highest_sigma_3()},
                 {.label = "Mohr–Coulomb", .colour = of_colour, .width = 1.8, .dashes = 4});
  ChartSeries sheared{.kind = ChartSeries::Kind::marks,
                      .label = "direct shear tests",
                      .colour = of_colour,
                      .width = 1.4,
                      .mark = 1};
  for (const auto& test : of.series().tests)
    if (test.record.kind.pressure_acts_across && test.results.peak_stress.value &&
        test.results.normal_stress_at_peak.value)
      sheared.points.push_back(
        {*test.results.normal_stress_at_peak.value / mega, *test.results.peak_stress.value / mega});
  chart.series.push_back(std::move(sheared));
  return {{.name = "mohr_" + file_name(of.series().label),
           .caption = std::string("Mohr circles of the strengths") +
                      (residual.empty() ? "" : " and residual strengths") +
                      "; the envelopes touch them as the fits of σ₁ over σ₃ say",
           .alternative = "Mohr circles of the mean strengths, in tension and under each confinement, with the fitted "
                          "envelopes in the plane of normal and shear stress.",
           .width = 660,
           .height = 480,
           .panels = {std::move(chart)}}};
}

Pictures p_q_picture(const AllSeries& of)
{
  Chart chart{.x = {.label = "mean stress p = (σ₁ + σ₂ + σ₃)/3 [MPa], compression positive"},
              .y = {.label = "q = σ₁ − σ₃ [MPa]", .from = 0.0}};
  bool any_compression = false;
  for (std::size_t n = 0; n < of.all.size(); ++n)
    {
      const Series& series = of.all[n];
      const StrengthData& data = of.envelopes[n].data;
      any_compression |= !data.points.empty();
      ChartSeries marks{.kind = ChartSeries::Kind::marks,
                        .label = series.label,
                        .colour = colour(series, n),
                        .width = 1.4,
                        .mark = point_type(series)};
      const auto of_state = [](const double sigma_3, const double sigma_1) {
        return ChartPoint{(sigma_1 + 2.0 * sigma_3) / 3.0 / mega, (sigma_1 - sigma_3) / mega};
      };
      for (const auto& point : data.points)
        marks.points.push_back(of_state(point.sigma_3, point.sigma_1));
      if (data.tensile_strength) // the two other principal stresses are 0
        marks.points.push_back({-*data.tensile_strength / 3.0 / mega, *data.tensile_strength / mega});
      if (const HoekBrownFit* const fit = of.envelopes[n].representative())
        {
          // Line of confined compression; between compression and tension no path of states is unique.
          ChartSeries line{.label = series.label + ": " + label_of(*fit),
                           .colour = colour(series, n),
                           .width = 2.0,
                           .dashes = dashes(n)};
          for (const double sigma_3 : abscissas(0.0, fit->quality.highest_sigma_3()))
            line.points.push_back(of_state(sigma_3, fit->sigma_1(sigma_3)));
          chart.series.push_back(std::move(line));
        }
      chart.series.push_back(std::move(marks));
      ChartSeries residual{.label = series.label + ": residual",
                           .colour = colour(series, n),
                           .width = 1.2,
                           .dashes = 3};
      for (const auto& point : residual_points(series))
        residual.points.push_back(of_state(point.sigma_3, point.sigma_1));
      if (residual.points.size() > 1)
        chart.series.push_back(std::move(residual));
    }
  if (!any_compression)
    return {};
  return picture_of(std::move(chart), 660, 480, "p_q",
                    "Strengths over the mean stress. Under confinement σ₂ = σ₃; in tension σ₁ = σ₂ = 0",
                    "The difference of the largest and the smallest principal stress at failure against their mean.");
}
} // namespace feldspar

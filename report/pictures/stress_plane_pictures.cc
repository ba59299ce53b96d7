#include "report/pictures/stress_plane_pictures.h"

#include "report/live/chart.h"
#include "report/pictures/envelope_plot.h"
#include "report/pictures/plane_plot.h"
#include "report/pictures/plot_style.h"
#include "results/fits/residual_strength.h"
#include "results/runs/test_groups.h"
#include "results/statistics.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <numbers>
#include <utility>

namespace feldspar
{
namespace
{
using namespace plot;

using Points = std::vector<std::array<double, 2>>;

constexpr int n_of_a_curve = 120;

/// Closer where an envelope bends, near its beginning.
std::vector<double> abscissas(const double begin, const double end)
{
  std::vector<double> result;
  for (int k = 0; k <= n_of_a_curve; ++k)
    result.push_back(begin + (end - begin) * std::pow(double(k) / n_of_a_curve, 3.0));
  return result;
}

void add_circle(PlanePlot& plotted, const double sigma_3, const double sigma_1, ChartLine looks)
{
  constexpr int n_points = 90;
  for (int k = 0; k <= n_points; ++k)
    {
      const double angle = std::numbers::pi * (1.0 - double(k) / n_points);
      looks.points.push_back({(0.5 * (sigma_1 + sigma_3) + 0.5 * (sigma_1 - sigma_3) * std::cos(angle)) / mega,
                              0.5 * (sigma_1 - sigma_3) * std::sin(angle) / mega});
    }
  plotted.add(std::move(looks));
}

std::string name_for_files(const Series& series) { return file_name(series.label); }
} // namespace

PlaneStress touching_point(const std::function<double(double)>& sigma_1, const double sigma_3)
{
  const double step = std::max(1.0, 1e-6 * std::abs(sigma_3)); // [Pa]
  const double slope = (sigma_1(sigma_3 + step) - sigma_1(sigma_3)) / step;
  const double normal = sigma_3 + (sigma_1(sigma_3) - sigma_3) / (slope + 1.0);
  return {normal, (normal - sigma_3) * std::sqrt(slope)};
}

std::vector<Picture> mohr_picture(const Series& series, const std::size_t which, const StrengthEnvelopes& envelopes)
{
  const StrengthData& data = envelopes.data;
  if (data.points.size() + (data.tensile_strength ? 1 : 0) < 2)
    return {};
  const std::string of_colour = colour(series, which);
  PlanePlot plotted({.x_label = "normal stress σ_n [MPa], compression positive",
                     .y_label = "shear stress τ [MPa]",
                     .equal_scales = true});
  double highest = 0.0;
  double lowest = 0.0;
  const std::string circles = "strengths, means";
  bool has_key = false;
  const auto add_strength = [&](const double sigma_3, const double sigma_1, const std::string& label) {
    add_circle(
      plotted, sigma_3, sigma_1,
      {.label = has_key ? label : circles, .goes_with = has_key ? circles : "", .colour = of_colour, .width = 1.2});
    has_key = true;
    highest = std::max(highest, sigma_1);
    lowest = std::min(lowest, sigma_3);
  };
  for (const auto& point : data.points)
    add_strength(point.sigma_3, point.sigma_1, fmt::format("σ₃ = {:g} MPa", point.sigma_3 / mega));
  if (data.tensile_strength)
    add_strength(-*data.tensile_strength, 0.0, "tension");
  const auto residual = residual_points(series);
  for (std::size_t k = 0; k < residual.size(); ++k)
    {
      const std::string label = "residual strengths, means";
      add_circle(plotted, residual[k].sigma_3, residual[k].sigma_1,
                 {.label = k ? fmt::format("residual, σ₃ = {:g} MPa", residual[k].sigma_3 / mega) : label,
                  .goes_with = k ? label : "",
                  .colour = of_colour,
                  .width = 1.0,
                  .dashes = 3});
    }
  if (const HoekBrownFit* const fit = envelopes.representative())
    {
      ChartLine line{.label = label_of(*fit), .colour = of_colour, .width = 2.4};
      const double begin = fit->quality.lowest_sigma_3();
      // At its beginning the envelope may stand upright.
      for (const double sigma_3 : abscissas(begin + 1e-9 * std::abs(begin), fit->quality.highest_sigma_3()))
        {
          const auto [normal, shear] = touching_point([&](const double x) { return fit->sigma_1(x); }, sigma_3);
          if (std::isfinite(normal) && std::isfinite(shear))
            line.points.push_back({normal / mega, shear / mega});
        }
      plotted.add(std::move(line));
    }
  if (const auto& fit = envelopes.mohr_coulomb.fit; fit && fit->quality.degrees_of_freedom > 0)
    {
      ChartLine line{.label = "Mohr–Coulomb", .colour = of_colour, .width = 1.8, .dashes = 4};
      for (const double sigma_3 : {fit->quality.lowest_sigma_3(), fit->quality.highest_sigma_3()})
        {
          const auto [normal, shear] = touching_point([&](const double x) { return fit->sigma_1(x); }, sigma_3);
          line.points.push_back({normal / mega, shear / mega});
        }
      plotted.add(std::move(line));
    }
  ChartLine sheared{.kind = ChartLine::Kind::marks, .label = "direct shear tests", .colour = of_colour, .mark = 1};
  for (const auto& test : series.tests)
    if (test.record.kind.pressure_acts_across && test.results.peak_stress.value &&
        test.results.normal_stress_at_peak.value)
      sheared.points.push_back(
        {*test.results.normal_stress_at_peak.value / mega, *test.results.peak_stress.value / mega});
  plotted.add(std::move(sheared));
  const double reach = 1.03 * highest / mega;
  return {
    {.name = "mohr_" + name_for_files(series),
     .caption = std::string("Mohr circles of the strengths") + (residual.empty() ? "" : " and residual strengths") +
                "; the envelopes touch them as the fits of σ₁ over σ₃ say",
     .alternative = "Mohr circles of the mean strengths, in tension and under each confinement, with the fitted "
                    "envelopes in the plane of normal and shear stress.",
     .width = 660,
     .height = 480,
     .script = plotted.script(fmt::format("set size ratio -1\nset xrange [{:.5g}:{:.5g}]; set yrange [0:{:.5g}]\n"
                                          "set arrow from 0, graph 0 to 0, graph 1 nohead lw 0.8 lc rgb '#b0b0b0' "
                                          "back\nset key maxcols 3\n",
                                          1.1 * lowest / mega, reach, 0.56 * reach)),
     .live = plotted.json()}};
}

std::vector<Picture> p_q_picture(const std::vector<Series>& all, const std::vector<StrengthEnvelopes>& envelopes)
{
  PlanePlot plotted(
    {.x_label = "mean stress p = (σ₁ + σ₂ + σ₃)/3 [MPa], compression positive", .y_label = "q = σ₁ − σ₃ [MPa]"});
  constexpr int width = 660; // [px]
  bool any_compression = false;
  for (std::size_t n = 0; n < all.size(); ++n)
    {
      const StrengthData& data = envelopes[n].data;
      any_compression |= !data.points.empty();
      ChartLine marks{.kind = ChartLine::Kind::marks,
                      .label = all[n].label,
                      .colour = colour(all[n], n),
                      .mark = point_type(all[n])};
      const auto of_state = [](const double sigma_3, const double sigma_1) {
        return std::array{(sigma_1 + 2.0 * sigma_3) / 3.0 / mega, (sigma_1 - sigma_3) / mega};
      };
      for (const auto& point : data.points)
        marks.points.push_back(of_state(point.sigma_3, point.sigma_1));
      if (data.tensile_strength) // the two other principal stresses are 0
        marks.points.push_back({-*data.tensile_strength / 3.0 / mega, *data.tensile_strength / mega});
      if (const HoekBrownFit* const fit = envelopes[n].representative())
        {
          // Of confined compression; between it and tension no path of states is unique.
          ChartLine line{.label = all[n].label + ": " + label_of(*fit),
                         .colour = colour(all[n], n),
                         .width = 2.0,
                         .dashes = dashes(n)};
          for (const double sigma_3 : abscissas(0.0, fit->quality.highest_sigma_3()))
            line.points.push_back(of_state(sigma_3, fit->sigma_1(sigma_3)));
          plotted.add(std::move(line));
        }
      plotted.add(std::move(marks));
      ChartLine residual{.label = all[n].label + ": residual", .colour = colour(all[n], n), .width = 1.2, .dashes = 3};
      for (const auto& point : residual_points(all[n]))
        residual.points.push_back(of_state(point.sigma_3, point.sigma_1));
      if (residual.points.size() > 1)
        plotted.add(std::move(residual));
    }
  if (!any_compression)
    return {};
  return {
    {.name = "p_q",
     .caption = "Strengths over the mean stress. Under confinement σ₂ = σ₃; in tension σ₁ = σ₂ = 0",
     .alternative = "The difference of the largest and the smallest principal stress at failure against their mean.",
     .width = width,
     .height = 480 + plotted.columns().further_height(width),
     .script = plotted.script("set yrange [0:*]\nset arrow from 0, graph 0 to 0, graph 1 nohead lw 0.8 lc rgb "
                              "'#b0b0b0' back\n" +
                              plotted.columns().set_up(width) + "\n"),
     .live = plotted.json()}};
}
} // namespace feldspar

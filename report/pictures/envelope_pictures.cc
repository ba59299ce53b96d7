#include "report/pictures/envelope_pictures.h"

#include "report/pictures/envelope_plot.h"
#include "report/pictures/plot_style.h"
#include "results/runs/test_groups.h"
#include "results/statistics.h"

#include <fmt/format.h>

#include <algorithm>
#include <iterator>

namespace feldspar
{
namespace
{
using namespace plot;

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
              plotted.add_cut_off(fit, of_colour);
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
     .caption = (envelopes.data.of_flawed_body ? std::string("Envelope of highest nominal stresses")
                                               : std::string("Strength envelope")) +
                (all.size() > 1 ? " of " + all[which].label : std::string()),
     .alternative = "Strength against confinement: mean and standard deviation of the model's tests, the Hoek–Brown "
                    "forms, Mohr–Coulomb, and the reference. The figures are in the tables below.",
     .width = plotted.width,
     .height = plotted.height(),
     .script = plotted.script(),
     .live = plotted.json()});
  // Near the uniaxial test, where the forms differ.
  if (envelopes.data.uniaxial_compressive_strength && plotted.highest_3 > 0.0)
    {
      const EnvelopePoint upper{0.2 * plotted.highest_3, 2.2 * *envelopes.data.uniaxial_compressive_strength};
      pictures.push_back({.name = "envelope_near_uniaxial" + of_series,
                          .caption = "The same near the uniaxial and the tension test",
                          .alternative = "The strength envelope between tension and low confinement, enlarged.",
                          .width = plotted.width,
                          .height = plotted.height(),
                          .script = plotted.script(upper),
                          .live = plotted.json(upper)});
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
    if (const HoekBrownFit* const fit = envelopes[n].representative())
      plotted.add_fit(*fit, {2.0, dashes(n), colour(all[n], n)}, all[n].label + ": " + label_of(*fit));
  if (reference)
    plotted.add_fit_of(reference->experiment);
  return {{.name = "envelopes",
           .caption = "Strength of all series",
           .alternative = "Strength against confinement of all series, each with its Hoek–Brown envelope.",
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

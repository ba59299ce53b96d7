#include "laboratory/named_entries.h"
#include "report/sections/sections.h"

#include "base/append.h"
#include "report/sections/text.h"
#include "results/folder/result_folder.h"

#include <boost/algorithm/string/replace.hpp>
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdlib>
#include <map>
#include <numbers>
#include <optional>
#include <utility>

namespace feldspar
{
namespace
{
using namespace text;

/// Terminal text writes stresses out.
std::string with_symbols(std::string text)
{
  for (const auto& [word, symbol] :
       {std::pair("sigma_3", "σ₃"), {"sigma_1", "σ₁"}, {"sigma_t", "σ_t"}, {"sigma_ci", "σ_ci"}, {"<=", "≤"}})
    boost::replace_all(text, word, symbol);
  return text;
}

/// The likely cause of points that rise most steeply up to the first confinement, where platens let the ends widen.
std::string remark_on_platens(const Series& series, const StrengthData& data)
{
  std::string friction = series.made_by.value_of(input_entries::platen_friction);
  if (!series.tests.empty())
    for (const VariantSetting& setting : series.tests.front().settings)
      if (setting.entry == input_entries::platen_friction.text())
        friction = setting.value;
  if (series.kind != SeriesKind::specimens || friction.empty() || std::strtod(friction.c_str(), nullptr) != 0.0 ||
      !rises_more_steeply_under_confinement(data))
    return "";
  return fmt::format(
    "The strengths rise most steeply up to the first confinement. Smooth platens are a likely cause: between them a specimen splits "
    "early without confinement. The friction of a laboratory's platens raises the uniaxial strength most ({}).",
    input_entries::platen_friction.text());
}

std::string text_of(const MohrCoulombFit& fit)
{
  return fmt::format("Mohr–Coulomb: friction angle {}°, cohesion {} MPa (± half of the 95 % interval of this fit).",
                     estimate(fit.friction_angle, std::numbers::pi / 180.0, 1), estimate(fit.cohesion, mega, 1));
}

/// Verdict on a fit. Without freedom there is nothing to be judged, and parameters that the points leave open, because their
/// intervals reach 0, are not admissible.
std::string verdict_on(const FitQuality& quality, const std::vector<Estimate>& parameters, const std::string& otherwise)
{
  if (quality.degrees_of_freedom == 0)
    return "no more points than parameters: not drawn";
  const bool any_open = std::ranges::any_of(parameters, [](const Estimate& one) {
    return one.half_width.value && *one.half_width.value >= std::abs(one.value);
  });
  return any_open ? "not determined: an interval reaches 0" : otherwise;
}

Table fit_table(const StrengthEnvelopes& envelopes, const std::string& name)
{
  const auto& measured = envelopes.data;
  const auto stress = [](const std::optional<double>& value, const int decimals) {
    return value ? number(*value / mega, decimals) : none;
  };
  const auto beside = [](const double fitted, const std::optional<double>& was_measured) {
    return was_measured ? fmt::format(" ({})", signed_percent(fitted / *was_measured - 1.0)) : std::string();
  };
  Table table{
    name,
    fmt::format(
      "Envelopes, Hoek–Brown and Mohr–Coulomb: parameters ± half of the 95 % interval, stresses in MPa; fitted strengths "
      "with their deviation from the measured ones, UCS {} and σ_t {}",
      stress(measured.uniaxial_compressive_strength, 1), stress(measured.tensile_strength, 2)),
    {"form", "admissible", "σ_ci", "m", "s", "a", "R²", "RMS", "fitted UCS", "fitted σ_t"}};
  const auto add = [&](std::vector<std::string> row) {
    row.resize(table.header.size(), none);
    table.rows.push_back(std::move(row));
  };
  for (const auto& [of_form, with_tension_point, answer] : envelopes.hoek_brown)
    {
      const std::string form =
        title(of_form) + (with_tension_point ? fmt::format(", {} σ_t", *with_tension_point ? "with" : "without") : "");
      if (!answer.fit)
        {
          add({form, "no fit: " + with_symbols(answer.reason)});
          continue;
        }
      const HoekBrownFit& fit = *answer.fit;
      add(
        {form, verdict_on(fit.quality, {fit.sigma_ci, fit.m, fit.s, fit.a}, fit.s.value > 1.0005 ? "✗ s > 1" : "✓"),
         estimate(fit.sigma_ci, mega, 1), estimate(fit.m, 1.0, 1), estimate(fit.s, 1.0, 2), estimate(fit.a, 1.0, 3),
         number(fit.quality.r_squared, 1.0, 4), number(fit.quality.root_mean_square / mega, 1),
         estimate(fit.uniaxial_compressive_strength, mega, 1) +
           beside(fit.uniaxial_compressive_strength.value, measured.uniaxial_compressive_strength),
         number(-fit.tensile_cut_off.value / mega, 2) + beside(-fit.tensile_cut_off.value, measured.tensile_strength)});
    }
  if (const auto& fit = envelopes.mohr_coulomb.fit)
    add({"Mohr–Coulomb", verdict_on(fit->quality, {fit->friction_angle, fit->cohesion}, "✓"), none, none, none, none,
         number(fit->quality.r_squared, 1.0, 4), number(fit->quality.root_mean_square / mega, 1),
         estimate(fit->uniaxial_strength, mega, 1) +
           beside(fit->uniaxial_strength.value, measured.uniaxial_compressive_strength)});
  else
    add({"Mohr–Coulomb", "no fit: " + with_symbols(envelopes.mohr_coulomb.reason)});
  return table;
}

Table residual_table(const StrengthEnvelopes& envelopes, const std::string& name)
{
  Table table{name, "Residuals: σ₁ of each point less that of the envelope [MPa]", {"σ₃ [MPa]", "σ₁ [MPa]"}};
  std::map<std::pair<double, double>, std::map<std::size_t, double>> residuals;
  std::size_t n_fits = 0;
  for (const auto& record : records(envelopes))
    {
      if (!record.reason.empty())
        continue;
      std::string heading = title_of_form(record.form) + (record.variant.empty() ? "" : ", " + record.variant);
      std::ranges::replace(heading, '_', ' ');
      table.header.push_back(heading);
      for (const auto& [point, residual] : record.residuals)
        residuals[{point.sigma_3, point.sigma_1}][n_fits] = residual;
      ++n_fits;
    }
  for (const auto& [point, of_fits] : residuals)
    {
      std::vector<std::string> row{number(point.first / mega, 2), number(point.second / mega, 1)};
      for (std::size_t k = 0; k < n_fits; ++k)
        row.push_back(of_fits.contains(k) ? number(of_fits.at(k) / mega, 1) : none);
      table.rows.push_back(row);
    }
  return table;
}

/// Remark whether an envelope that another source prints meets its own uniaxial tests; empty if there is none.
std::string remark_on_printed(const ReferenceSource& source)
{
  const auto measured = source.find("uniaxial_compressive_strength_MPa");
  if (!source.envelope || !measured)
    return "";
  const double fitted = source.envelope->sigma_1(0.0) / mega;
  std::string text = fmt::format(
    "{}: the printed envelope has s = {:.2f} and says {:.0f} MPa at σ₃ = 0, where its own tests gave {:.0f} MPa",
    source.label, source.envelope->s, fitted, measured->middle());
  if (source.envelope->s > 1.0)
    text += ": with s > 1 the strength σ_ci·sᵃ at σ₃ = 0 exceeds σ_ci";
  return text + ".";
}

/// Returns whether the strengths lie at two or more places of the axis of σ₃, tension being one of them: fewer are no
/// envelope.
bool make_an_envelope(const StrengthData& data)
{
  return !data.points.empty() && (data.tensile_strength || std::ranges::any_of(data.points, [&](const auto& point) {
                                    return point.sigma_3 != data.points.front().sigma_3;
                                  }));
}

/// Block of a series that the page has no room for: its pictures are files.
PageBlock as_files(const Findings& findings, const std::size_t n, PictureBook& book)
{
  const StrengthEnvelopes& envelopes = findings.envelopes[n];
  book.keep_as_files(pictures_of(strength_figures, findings.among(n)));
  book.keep_as_files(pictures_of(residual_figures, findings.among(n)));
  return {.tables_as_files = {fit_table(envelopes, "envelopes" + findings.ending_of_files(n)),
                              residual_table(envelopes, "residuals" + findings.ending_of_files(n))}};
}

/// The envelopes of the experiment's own points, and its tests that are none of them; empty where there is neither.
PageBlock experiment_block(const ReferenceSource& experiment)
{
  PageBlock block;
  if (experiment.fitted.data.points.size() >= 2)
    {
      block.tables.push_back(fit_table(experiment.fitted, "envelopes_experiment"));
      if (const auto& fit = experiment.fitted.mohr_coulomb.fit)
        block.paragraphs.push_back(text_of(*fit));
    }
  if (!experiment.true_triaxial.empty())
    {
      Table table{"true_triaxial_experiment", "Strengths under three different stresses [MPa]", {"σ₃", "σ₂", "σ₁"}};
      for (const auto& [sigma_3, sigma_2, sigma_1] : experiment.true_triaxial)
        table.rows.push_back({number(sigma_3 / mega, 1), number(sigma_2 / mega, 1), number(sigma_1 / mega, 1)});
      block.tables.push_back(table);
      block.paragraphs.push_back(
        "Strengths with σ₂ above σ₃ are points of no envelope here: the criteria of Hoek and Brown "
        "and of Mohr and Coulomb know no σ₂, which raises the strength of rock.");
    }
  if (!block.tables.empty())
    block.subheading = experiment.label + ": its own points";
  return block;
}

/// The constants of a rock mass of the wanted strength index, from the intact form of the experiment and of each series.
PageBlock rock_mass_block(const Findings& findings)
{
  const ReferenceSource& experiment = findings.reference->experiment;
  PageBlock block;
  if (!experiment.rock_mass)
    return block;
  const double strength_index = experiment.rock_mass->strength_index;
  const double disturbance = experiment.rock_mass->disturbance;
  Table table{
    "rock_mass",
    fmt::format("Rock mass of GSI {:g} and D {:g} (Hoek, Carranza-Torres and Corkum 2002), from the intact form "
                "without σ_t; σ_c = σ_ci sᵃ, σ_t = s σ_ci / m_b; stresses in MPa",
                strength_index, disturbance),
    {"intact rock", "σ_ci", "m_i", "m_b", "s", "a", "σ_c", "σ_t"}};
  const auto add = [&](const std::string& label, const StrengthEnvelopes& envelopes) {
    for (const auto& [form, with_tension_point, answer] : envelopes.hoek_brown)
      if (form == HoekBrownForm::intact && !*with_tension_point)
        {
          if (!answer.fit)
            {
              table.rows.push_back(
                {label, "no fit: " + with_symbols(answer.reason), none, none, none, none, none, none});
              continue;
            }
          const double sigma_ci = answer.fit->sigma_ci.value;
          const auto [m, s, a] = rock_mass_constants(answer.fit->m.value, strength_index, disturbance);
          table.rows.push_back({label, number(sigma_ci / mega, 1), number(answer.fit->m.value, 1), number(m, 3),
                                number(s, 4), number(a, 3), number(sigma_ci * std::pow(s, a) / mega, 2),
                                number(s * sigma_ci / m / mega, 3)});
        }
  };
  add(experiment.label, experiment.fitted);
  for (std::size_t n = 0; n < findings.all.size(); ++n)
    if (findings.is_in_full(n))
      add(findings.all[n].label, findings.envelopes[n]);
  block.subheading = "Rock mass";
  block.tables.push_back(table);
  return block;
}
} // namespace

PageSection envelope_section(const Findings& findings, PictureBook& book)
{
  PageSection section{"envelope", "Envelope", "Strength envelope"};
  const std::vector<StrengthEnvelopes> pictured_envelopes = findings.pictured_envelopes();
  const bool any_envelope =
    findings.reference ||
    std::ranges::any_of(findings.envelopes, [](const StrengthEnvelopes& one) { return make_an_envelope(one.data); });
  if (!any_envelope && findings.has_several())
    {
      section.blocks.push_back(
        {.paragraphs = {
           "No series has strengths at two confinements, or in compression and tension, so there is no envelope."}});
      return section;
    }
  Pictures of_all =
    pictures_of(strength_figures_of_all, AllSeries{findings.pictured, pictured_envelopes, findings.reference});
  if (any_envelope && findings.has_several() && !of_all.empty())
    section.blocks.push_back({.pictures = book.keep(of_all)});
  for (std::size_t n = 0; n < findings.all.size(); ++n)
    {
      const StrengthEnvelopes& envelopes = findings.envelopes[n];
      if (findings.all[n].kind == SeriesKind::laboratory_curve && !make_an_envelope(envelopes.data))
        continue;
      if (!findings.is_in_full(n))
        {
          if (make_an_envelope(envelopes.data))
            section.blocks.push_back(as_files(findings, n, book));
          continue;
        }
      PageBlock block = findings.heading_of(n);
      const bool any_points = !envelopes.data.points.empty();
      if (!any_points || (!make_an_envelope(envelopes.data) && !findings.reference))
        {
          block.paragraphs.push_back(any_points
                                       ? "All strengths of this series are at one confinement, so there is no envelope."
                                       : "No compression test of this series has a strength, so there is no envelope.");
          section.blocks.push_back(block);
          continue;
        }
      block.paragraphs.push_back(with_symbols(remark(envelopes)));
      if (const std::string platens = remark_on_platens(findings.all[n], envelopes.data); !platens.empty())
        block.paragraphs.push_back(platens);
      if (n == 0 && findings.reference)
        if (const std::string printed = remark_on_printed(findings.reference->model); !printed.empty())
          block.paragraphs.push_back(printed);
      if (!findings.has_several())
        block.pictures = book.keep(of_all);
      section.blocks.push_back(block);
      PageBlock figures{
        .folded = findings.titled("Every fitted form", findings.all[n]),
        .paragraphs = {"Each fit is drawn between the least and the largest σ₃ of its points, and only if it "
                       "has more points than parameters; q over p shows the part under compression."},
        .tables = {fit_table(envelopes, "envelopes" + findings.ending_of_files(n))},
        .pictures = book.keep(pictures_of(strength_figures, findings.among(n)))};
      if (const auto& fit = envelopes.mohr_coulomb.fit)
        figures.paragraphs.push_back(text_of(*fit));
      figures.paragraphs.push_back(
        "“s and a free” (σ_ci is the measured UCS) and “a free” (s = 1) are one family of curves, drawn as one. "
        "“With σ_t” counts the tensile strength as a point at σ₃ = −σ_t, σ₁ = 0. “Regression” is Hoek's, a straight line "
        "through (σ₁ − σ₃)² over σ₃, by which most printed m_i were found.");
      section.blocks.push_back(figures);
      if (auto residuals = book.keep(pictures_of(residual_figures, findings.among(n))); !residuals.empty())
        section.blocks.push_back({.folded = findings.titled("Residual of every point", findings.all[n]),
                                  .tables = {residual_table(envelopes, "residuals" + findings.ending_of_files(n))},
                                  .pictures = std::move(residuals)});
    }
  append(section.blocks, findings.remark_on_pictures(fmt::format("Pictures and fits of the others are in {}/ and {}/.",
                                                                 result_file::figures, result_file::tables)));
  if (findings.reference)
    for (PageBlock& block : std::array{experiment_block(findings.reference->experiment), rock_mass_block(findings)})
      if (!block.tables.empty())
        section.blocks.push_back(std::move(block));
  return section;
}
} // namespace feldspar

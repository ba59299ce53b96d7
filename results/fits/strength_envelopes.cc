#include "results/fits/strength_envelopes.h"

#include "base/text.h"
#include "results/fits/form_titles.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <numbers>
#include <tuple>
#include <utility>

namespace feldspar
{
namespace
{
constexpr double degree = std::numbers::pi / 180.0;

void add(std::vector<FitEntry>& entries, const std::string& quantity, const std::string& unit, const Estimate& estimate)
{
  entries.push_back({quantity + unit, {estimate.value, ""}});
  entries.push_back({quantity + "_confidence_95" + unit, estimate.half_width});
}

void add(std::vector<FitEntry>& entries, const FitQuality& quality)
{
  entries.push_back({"degrees_of_freedom", {double(quality.degrees_of_freedom), ""}});
  entries.push_back({"r_squared", quality.r_squared});
  entries.push_back({"root_mean_square_Pa", {quality.root_mean_square, ""}});
}

void add_measured(std::vector<FitEntry>& entries, const StrengthData& data)
{
  const auto figure = [](const std::optional<double>& value) { return Figure{value, value ? "" : "not measured"}; };
  entries.push_back({"measured_uniaxial_compressive_strength_Pa", figure(data.uniaxial_compressive_strength)});
  entries.push_back({"measured_tensile_strength_Pa", figure(data.tensile_strength)});
}

FitRecord record(const HoekBrownRow& row, const StrengthData& data)
{
  const auto& fit_or_reason = row.answer;
  FitRecord result{name(row.form), "", fit_or_reason.reason, {}, {}};
  if (row.with_tension_point)
    result.variant = *row.with_tension_point ? "with_tension_point" : "without_tension_point";
  if (!fit_or_reason.fit)
    return result;
  const auto& fit = *fit_or_reason.fit;
  add(result.entries, "sigma_ci", "_Pa", fit.sigma_ci);
  add(result.entries, "m", "", fit.m);
  add(result.entries, "s", "", fit.s);
  add(result.entries, "a", "", fit.a);
  add(result.entries, "uniaxial_compressive_strength", "_Pa", fit.uniaxial_compressive_strength);
  add(result.entries, "tensile_cut_off", "_Pa", fit.tensile_cut_off);
  add(result.entries, fit.quality);
  add_measured(result.entries, data);
  result.residuals = fit.quality.residuals;
  return result;
}

FitRecord record(const FitOrReason<MohrCoulombFit>& fit_or_reason, const StrengthData& data)
{
  FitRecord result{"mohr_coulomb", "", fit_or_reason.reason, {}, {}};
  if (!fit_or_reason.fit)
    return result;
  const auto& fit = *fit_or_reason.fit;
  add(result.entries, "friction_angle", "_rad", fit.friction_angle);
  add(result.entries, "cohesion", "_Pa", fit.cohesion);
  add(result.entries, "slope", "", fit.slope);
  add(result.entries, "uniaxial_compressive_strength", "_Pa", fit.uniaxial_strength);
  add(result.entries, fit.quality);
  add_measured(result.entries, data);
  result.residuals = fit.quality.residuals;
  return result;
}

/// "value ± half-width", without the latter where there is none.
std::string text(const Estimate& estimate, const int decimals, const double unit = 1.0)
{
  std::string result = fmt::format("{:.{}f}", estimate.value / unit, decimals);
  if (estimate.half_width.value)
    result += fmt::format(" ± {:.{}f}", *estimate.half_width.value / unit, decimals);
  return result;
}

std::string text(const Figure& figure, const int decimals, const double unit = 1.0)
{
  return figure.value ? fmt::format("{:.{}f}", *figure.value / unit, decimals) : "-";
}

using Row = std::array<std::string, 5>;

/// All columns but the first to the right; fmt counts characters, not bytes.
std::string table(const std::vector<Row>& rows)
{
  std::array<std::size_t, std::tuple_size_v<Row>> width{};
  for (const auto& row : rows)
    for (std::size_t c = 0; c < row.size(); ++c)
      width[c] = std::max(width[c], width_of(row[c]));
  std::string result;
  for (const auto& row : rows)
    {
      std::string line = fmt::format("{:<{}}", row[0], width[0]);
      for (std::size_t c = 1; c < row.size(); ++c)
        line += fmt::format("  {:>{}}", row[c], width[c]);
      result += line.substr(0, line.find_last_not_of(' ') + 1) + '\n';
    }
  return result;
}

/// Fit with the tension point, where the strengths have one, and more points than parameters; null if there is none.
const HoekBrownFit* fit_with_freedom(const StrengthEnvelopes& envelopes, const HoekBrownForm form)
{
  for (const auto& pair : envelopes.hoek_brown)
    if (const auto& fit =
          envelopes.data.tensile_strength ? pair.with_tension_point.fit : pair.without_tension_point.fit;
        pair.form == form && fit && fit->quality.degrees_of_freedom > 0)
      return &*fit;
  return nullptr;
}

/// Remark that the intact form is no envelope of these strengths; begins with a space, empty where it is one.
std::string remark_on_intact_form(const StrengthEnvelopes& envelopes)
{
  const auto miss = miss_of_intact_form(envelopes);
  if (miss.value_or(0.0) <= largest_miss)
    return "";
  std::string result = fmt::format(" The intact form (s = 1, a = 0.5) misses the strengths by {:.0f} % of the uniaxial "
                                   "one (root mean square), so its sigma_ci and m do not describe them.",
                                   100.0 * *miss);
  if (const HoekBrownFit* const general = fit_with_freedom(envelopes, HoekBrownForm::general))
    result += fmt::format(" With a free (a = {:.2f}) it misses them by {:.0f} %.", general->a.value,
                          100.0 * general->quality.root_mean_square / *envelopes.data.uniaxial_compressive_strength);
  return result;
}
} // namespace

bool rises_more_steeply_under_confinement(const StrengthData& data)
{
  const EnvelopePoint* first = nullptr;
  for (const auto& point : data.points)
    if (point.sigma_3 > 0.0 && (!first || point.sigma_3 < first->sigma_3))
      first = &point;
  return first && data.tensile_strength && data.uniaxial_compressive_strength &&
         (first->sigma_1 - *data.uniaxial_compressive_strength) / first->sigma_3 >
           *data.uniaxial_compressive_strength / *data.tensile_strength;
}

std::vector<HoekBrownRow> StrengthEnvelopes::rows() const
{
  std::vector<HoekBrownRow> all;
  for (const HoekBrownPair& pair : hoek_brown)
    {
      all.push_back({pair.form, true, pair.with_tension_point});
      all.push_back({pair.form, false, pair.without_tension_point});
    }
  all.push_back({HoekBrownForm::regressed, std::nullopt, regressed});
  return all;
}

const HoekBrownFit* StrengthEnvelopes::representative() const
{
  const HoekBrownFit* const intact = fit_with_freedom(*this, HoekBrownForm::intact);
  const HoekBrownFit* const general = fit_with_freedom(*this, HoekBrownForm::general);
  const bool misses = miss_of_intact_form(*this).value_or(0.0) > largest_miss;
  const bool general_is_nearer =
    misses && general && general->quality.root_mean_square < 0.5 * intact->quality.root_mean_square;
  return general_is_nearer ? general : intact;
}

std::optional<double> miss_of_intact_form(const StrengthEnvelopes& envelopes)
{
  const HoekBrownFit* const intact = fit_with_freedom(envelopes, HoekBrownForm::intact);
  const auto& measured = envelopes.data.uniaxial_compressive_strength;
  if (!intact || !measured)
    return std::nullopt;
  return intact->quality.root_mean_square / *measured;
}

StrengthEnvelopes fit_strength_envelopes(const StrengthData& data)
{
  StrengthEnvelopes result{data, {}, regress_hoek_brown(data), fit_mohr_coulomb(data)};
  for (const auto form : {HoekBrownForm::as_paper, HoekBrownForm::intact, HoekBrownForm::general})
    result.hoek_brown.push_back({form, fit_hoek_brown(data, form, true), fit_hoek_brown(data, form, false)});
  return result;
}

std::vector<FitRecord> records(const StrengthEnvelopes& envelopes)
{
  std::vector<FitRecord> result;
  for (const HoekBrownRow& row : envelopes.rows())
    result.push_back(record(row, envelopes.data));
  result.push_back(record(envelopes.mohr_coulomb, envelopes.data));
  return result;
}

std::string as_text(const StrengthEnvelopes& envelopes)
{
  // Two tables, each of which fits on a terminal.
  std::vector<Row> rows;
  std::vector<Row> strengths;
  std::vector<std::string> notes;
  rows.push_back({"Hoek-Brown", "sigma_ci", "m", "s", "a"});
  strengths.push_back({"Hoek-Brown", "R²", "RMS", "UCS", "sigma_t"});
  for (const auto& [of_form, with_tension_point, answer] : envelopes.rows())
    {
      const std::string form = title(of_form) + (with_tension_point.value_or(true) ? "" : ", no σ_t");
      if (!answer.fit)
        {
          notes.push_back(fmt::format("{}: no fit: {}", form, answer.reason));
          continue;
        }
      const auto& fit = *answer.fit;
      rows.push_back({form, text(fit.sigma_ci, 1, 1e6), text(fit.m, 2), text(fit.s, 3), text(fit.a, 3)});
      strengths.push_back({form, text(fit.quality.r_squared, 4),
                           fmt::format("{:.1f}", fit.quality.root_mean_square / 1e6),
                           text(fit.uniaxial_compressive_strength, 1, 1e6),
                           text(Estimate{-fit.tensile_cut_off.value, fit.tensile_cut_off.half_width}, 2, 1e6)});
      // A value that the form itself fixes is no result.
      const bool fixes_s = of_form != HoekBrownForm::as_paper;
      std::vector<std::pair<std::string, std::vector<std::string>>> reasons;
      const auto add_reason = [&](const std::string& parameter, const Figure& half_width) {
        if (half_width.value)
          return;
        if (reasons.empty() || reasons.back().first != half_width.reason)
          reasons.push_back({half_width.reason, {}});
        reasons.back().second.push_back(parameter);
      };
      add_reason("m", fit.m.half_width);
      add_reason(fixes_s ? "sigma_ci" : "s", fixes_s ? fit.sigma_ci.half_width : fit.s.half_width);
      if (of_form == HoekBrownForm::as_paper || of_form == HoekBrownForm::general)
        add_reason("a", fit.a.half_width);
      for (const auto& [reason, parameters] : reasons)
        notes.push_back(fmt::format("{}: no interval of {}: {}", form, fmt::join(parameters, ", "), reason));
    }
  const auto measured = [](const std::optional<double>& value, const int decimals) {
    return value ? fmt::format("{:.{}f}", *value / 1e6, decimals) : std::string("-");
  };
  strengths.push_back({"measured", "", "", measured(envelopes.data.uniaxial_compressive_strength, 1),
                       measured(envelopes.data.tensile_strength, 2)});

  std::string result = (envelopes.data.of_flawed_body ? std::string("Envelopes of highest nominal stresses")
                                                      : std::string("Strength envelopes")) +
                       ": compression positive, MPa, ± 95 % confidence;\n"
                       "no σ_t: without the tensile strength as a point\n" +
                       table(rows) + table(strengths);
  if (const auto& fit = envelopes.mohr_coulomb.fit)
    result +=
      fmt::format("Mohr-Coulomb: friction angle {} deg, cohesion {} MPa,\n  R² {}, RMS {:.1f} MPa, UCS {} MPa\n",
                  text(fit->friction_angle, 1, degree), text(fit->cohesion, 1, 1e6), text(fit->quality.r_squared, 4),
                  fit->quality.root_mean_square / 1e6, text(fit->uniaxial_strength, 1, 1e6));
  else
    notes.push_back(fmt::format("Mohr-Coulomb: no fit: {}", envelopes.mohr_coulomb.reason));
  for (const auto& note : notes)
    result += note + '\n';
  return result + remark(envelopes) + '\n';
}

std::string remark(const StrengthEnvelopes& envelopes)
{
  std::string result =
    std::string(envelopes.data.of_flawed_body
                  ? "The points are highest nominal stresses of a body with flaws, not strengths of the rock. "
                  : "") +
    (envelopes.data.tension_is_indirect ? "The tensile strength is that of Brazilian tests, for want of direct ones. "
                                        : "") +
    "Admissible is s <= 1: with s > 1 the rock would be stronger than intact." + remark_on_intact_form(envelopes);
  const auto with_free_s =
    std::ranges::find_if(envelopes.hoek_brown, [](const auto& pair) { return pair.form == HoekBrownForm::as_paper; });
  const auto& measured = envelopes.data.uniaxial_compressive_strength;
  if (with_free_s == envelopes.hoek_brown.end() || !with_free_s->with_tension_point.fit || !measured)
    return result;
  const auto& with = *with_free_s->with_tension_point.fit;
  result += fmt::format(" With s and a free, the envelope with the tension point has s = {:.2f}.", with.s.value);
  if (with.s.value <= 1.0005) // but for what is shown of it
    return result;
  result += fmt::format(" It says {:.0f} MPa at sigma_3 = 0, where {:.0f} MPa were measured.",
                        with.uniaxial_compressive_strength.value / 1e6, *measured / 1e6);
  if (rises_more_steeply_under_confinement(envelopes.data))
    result += " The points rise more steeply from the uniaxial test to the first confinement than from tension to the "
              "uniaxial test. An envelope flattens all the way: one that begins at sigma_t passes above the uniaxial "
              "strength.";
  else
    result += " An envelope that begins at sigma_t and meets the points at high confinement passes above the uniaxial "
              "strength.";
  if (const auto& without = with_free_s->without_tension_point.fit)
    result += fmt::format(" Without the tension point s = {:.2f}.", without->s.value);
  return result;
}
} // namespace feldspar

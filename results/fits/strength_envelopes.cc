#include "results/fits/strength_envelopes.h"

#include "base/text.h"

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

/// An estimate of a fit by its name in result files.
template <typename Fit>
struct NamedEstimate
{
  std::string quantity;
  const char* unit;
  Estimate Fit::*estimate;
};

template <typename Fit>
FitRecord record(const std::string& form, const std::string& variant, const FitOrReason<Fit>& answer,
                 const std::vector<NamedEstimate<Fit>>& estimates, const StrengthData& data)
{
  FitRecord result{form, variant, answer.reason, {}, {}};
  if (!answer.fit)
    return result;
  for (const auto& [quantity, unit, estimate] : estimates)
    {
      result.entries.push_back({quantity + unit, {((*answer.fit).*estimate).value, ""}});
      result.entries.push_back({quantity + "_confidence_95" + unit, ((*answer.fit).*estimate).half_width});
    }
  const auto measured = [](const std::optional<double>& value) { return Figure{value, value ? "" : "not measured"}; };
  const FitQuality& quality = answer.fit->quality;
  for (const FitEntry& one :
       {FitEntry{"degrees_of_freedom", {double(quality.degrees_of_freedom), ""}},
        {"r_squared", quality.r_squared},
        {"root_mean_square_Pa", {quality.root_mean_square, ""}},
        {"measured_uniaxial_compressive_strength_Pa", measured(data.uniaxial_compressive_strength)},
        {"measured_tensile_strength_Pa", measured(data.tensile_strength)}})
    result.entries.push_back(one);
  result.residuals = quality.residuals;
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
  const HoekBrownFit* const fit = envelopes.fit(form, envelopes.data.tensile_strength.has_value());
  return fit && fit->quality.degrees_of_freedom > 0 ? fit : nullptr;
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

const HoekBrownFit* StrengthEnvelopes::fit(const HoekBrownForm form, const bool with_tension_point) const
{
  for (const HoekBrownRow& row : hoek_brown)
    if (row.form == form && row.with_tension_point.value_or(false) == with_tension_point && row.answer.fit)
      return &*row.answer.fit;
  return nullptr;
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
  StrengthEnvelopes result{data, {}, fit_mohr_coulomb(data)};
  for (const auto form : {HoekBrownForm::as_paper, HoekBrownForm::intact, HoekBrownForm::general})
    for (const bool with_tension_point : {true, false})
      result.hoek_brown.push_back({form, with_tension_point, fit_hoek_brown(data, form, with_tension_point)});
  result.hoek_brown.push_back({HoekBrownForm::regressed, std::nullopt, regress_hoek_brown(data)});
  return result;
}

std::vector<FitRecord> records(const StrengthEnvelopes& envelopes)
{
  using H = HoekBrownFit;
  using M = MohrCoulombFit;
  std::vector<FitRecord> result;
  for (const auto& [form, with_tension_point, answer] : envelopes.hoek_brown)
    result.push_back(record<H>(name(form),
                               !with_tension_point   ? ""
                               : *with_tension_point ? "with_tension_point"
                                                     : "without_tension_point",
                               answer,
                               {{"sigma_ci", "_Pa", &H::sigma_ci},
                                {"m", "", &H::m},
                                {"s", "", &H::s},
                                {"a", "", &H::a},
                                {"uniaxial_compressive_strength", "_Pa", &H::uniaxial_compressive_strength},
                                {"tensile_cut_off", "_Pa", &H::tensile_cut_off}},
                               envelopes.data));
  result.push_back(record<M>("mohr_coulomb", "", envelopes.mohr_coulomb,
                             {{"friction_angle", "_rad", &M::friction_angle},
                              {"cohesion", "_Pa", &M::cohesion},
                              {"slope", "", &M::slope},
                              {"uniaxial_compressive_strength", "_Pa", &M::uniaxial_strength}},
                             envelopes.data));
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
  for (const auto& [of_form, with_tension_point, answer] : envelopes.hoek_brown)
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
  const HoekBrownFit* const with = envelopes.fit(HoekBrownForm::as_paper, true);
  const auto& measured = envelopes.data.uniaxial_compressive_strength;
  if (!with || !measured)
    return result;
  result += fmt::format(" With s and a free, the envelope with the tension point has s = {:.2f}.", with->s.value);
  if (with->s.value <= 1.0005) // but for what is shown of it
    return result;
  result += fmt::format(" It says {:.0f} MPa at sigma_3 = 0, where {:.0f} MPa were measured.",
                        with->uniaxial_compressive_strength.value / 1e6, *measured / 1e6);
  if (rises_more_steeply_under_confinement(envelopes.data))
    result += " The points rise more steeply from the uniaxial test to the first confinement than from tension to the "
              "uniaxial test. An envelope flattens all the way: one that begins at sigma_t passes above the uniaxial "
              "strength.";
  else
    result += " An envelope that begins at sigma_t and meets the points at high confinement passes above the uniaxial "
              "strength.";
  if (const HoekBrownFit* const without = envelopes.fit(HoekBrownForm::as_paper, false))
    result += fmt::format(" Without the tension point s = {:.2f}.", without->s.value);
  return result;
}
} // namespace feldspar

#pragma once

#include "results/fits/hoek_brown.h"
#include "results/fits/mohr_coulomb.h"

#include <optional>
#include <string>
#include <vector>

namespace feldspar
{
/// A fit of Hoek and Brown's form among all.
struct HoekBrownRow
{
  HoekBrownForm form;
  std::optional<bool> with_tension_point; ///< none of a form that is fitted in one way only
  FitOrReason<HoekBrownFit> answer;
};

/// Every envelope of the same data.
struct StrengthEnvelopes
{
  StrengthData data;
  std::vector<HoekBrownRow> hoek_brown; ///< in the order of tables
  FitOrReason<MohrCoulombFit> mohr_coulomb;

  /// The fit of a form with the tension point or, as the regression always is, without; null if there is none.
  const HoekBrownFit* fit(HoekBrownForm form, bool with_tension_point) const;

  /// The envelope that stands for these strengths where only one is drawn: the intact form, with the tension point of
  /// strengths that have one. Where that misses its points and the general form does by less than half as much, the
  /// latter. Null where the intact form has no freedom left.
  const HoekBrownFit* representative() const;
};

/// Misfit of the intact form with the tension point: the root mean square over the measured uniaxial strength. None
/// where the form has no freedom left, or the uniaxial strength is not measured.
std::optional<double> miss_of_intact_form(const StrengthEnvelopes& envelopes);

/// Share of the uniaxial strength from which on an envelope is said to miss its points.
inline constexpr double largest_miss = 0.1;

/// Returns whether the points rise more steeply from the uniaxial test to the first confinement than from tension to
/// the uniaxial test, which no envelope with a <= 1 can follow.
bool rises_more_steeply_under_confinement(const StrengthData& data);

StrengthEnvelopes fit_strength_envelopes(const StrengthData& data);

/// A figure of a fit by its name in result files, which ends in its SI unit.
struct FitEntry
{
  std::string name;
  Figure figure;
};

/// A fit as result files have it.
struct FitRecord
{
  std::string form;    ///< as_paper, intact, general, intact_by_regression or mohr_coulomb
  std::string variant; ///< with_tension_point or without_tension_point; empty where there is only one
  std::string reason;  ///< why there is no fit; then the rest is empty
  /// Each estimate is followed by its `_confidence_95`, the half-width of its 95 % interval.
  std::vector<FitEntry> entries;
  std::vector<PointResidual> residuals;
};

std::vector<FitRecord> records(const StrengthEnvelopes& envelopes);

/// For a terminal: parameters, R², RMS, fitted against measured strengths, and the remark.
std::string as_text(const StrengthEnvelopes& envelopes);

/// Remark in words: what is admissible, and why the paper's form says more than the measured uniaxial strength, if it
/// does.
std::string remark(const StrengthEnvelopes& envelopes);
} // namespace feldspar

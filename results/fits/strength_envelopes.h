#pragma once

#include "results/fits/hoek_brown.h"
#include "results/fits/mohr_coulomb.h"

#include <string>
#include <vector>

namespace feldspar
{
struct HoekBrownPair
{
  HoekBrownForm form;
  FitOrReason<HoekBrownFit> with_tension_point;
  FitOrReason<HoekBrownFit> without_tension_point;
};

/// Every envelope of the same data.
struct StrengthEnvelopes
{
  StrengthData data;
  std::vector<HoekBrownPair> hoek_brown; ///< as_paper, intact, general
  FitOrReason<MohrCoulombFit> mohr_coulomb;
};

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
  std::string form;    ///< as_paper, intact, general or mohr_coulomb
  std::string variant; ///< with_tension_point or without_tension_point; empty where there is only one
  std::string reason;  ///< why there is no fit; then the rest is empty
  /// Each estimate is followed by its `_confidence_95`, the half-width of its 95 % interval.
  std::vector<FitEntry> entries;
  std::vector<PointResidual> residuals;
};

std::vector<FitRecord> records(const StrengthEnvelopes& envelopes);

/// For a terminal: parameters, R², RMS, fitted against measured strengths, and the remark.
std::string as_text(const StrengthEnvelopes& envelopes);

/// In words: what is admissible, and why the paper's form says more than the measured uniaxial strength, if it does.
std::string remark(const StrengthEnvelopes& envelopes);
} // namespace feldspar

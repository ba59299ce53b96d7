#pragma once

#include "results/fits/fit.h"

#include <string>

namespace feldspar
{
/// Free parameters of the Hoek-Brown envelope.
enum class HoekBrownForm
{
  as_paper, ///< m, s, a; sigma_ci is the measured uniaxial compressive strength
  intact,   ///< sigma_ci, m (m_i of intact rock); s = 1, a = 0.5
  general   ///< sigma_ci, m, a; s = 1
};

/// The name used in result files.
std::string name(HoekBrownForm form);

/// sigma_3 + sigma_ci (m sigma_3/sigma_ci + s)^a (16); NaN beyond the tensile cut-off.
double hoek_brown_sigma_1(double sigma_3, double sigma_ci, double m, double s, double a);

/// sigma_1 = sigma_3 + sigma_ci (m sigma_3/sigma_ci + s)^a (16).
struct HoekBrownFit
{
  HoekBrownForm form;
  bool with_tension_point;
  Estimate sigma_ci; ///< [Pa]
  Estimate m;
  Estimate s;
  Estimate a;
  Estimate uniaxial_compressive_strength; ///< sigma_1 at sigma_3 = 0, sigma_ci s^a [Pa]
  Estimate tensile_cut_off;               ///< sigma_3 at which the bracket vanishes, -s sigma_ci/m [Pa]
  FitQuality quality;

  /// NaN below the cut-off.
  double sigma_1(double sigma_3) const;
};

/// Bounded least squares in sigma_1 with m > 0, s > 0, 0.05 <= a <= 1 (docs/theory.md §6.1). With the tension point the
/// measured tensile strength counts as one point more, (-sigma_t, 0), at which the bracket stays >= 0. The same data
/// give the same bits.
FitOrReason<HoekBrownFit> fit_hoek_brown(const StrengthData& data, HoekBrownForm form, bool with_tension_point);

/// m_i of intact rock by its strengths in compression: m of the intact form through these points, two of which suffice. None
/// without a confined one beside the uniaxial one, and where the deviator does not grow with the pressure.
std::optional<double> rock_constant(const std::vector<EnvelopePoint>& in_compression);
} // namespace feldspar

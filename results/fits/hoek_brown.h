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
  general,  ///< sigma_ci, m, a; s = 1
  regressed ///< the intact form by Hoek's regression of (sigma_1 - sigma_3)² over sigma_3
};

/// The name used in result files.
std::string name(HoekBrownForm form);

/// The name of a form as readers see it, by the parameters that are free; a rock need have no paper.
std::string title(HoekBrownForm form);

/// The same by the name of an envelope in result files.
std::string title_of_form(const std::string& name_in_files);

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

/// The intact form by the linear regression of (sigma_1 - sigma_3)² = m sigma_ci sigma_3 + sigma_ci² over sigma_3 (Hoek and
/// Brown 1980), by which most printed m_i were found. It weighs the strong points most, and so gives another m than least
/// squares in sigma_1.
FitOrReason<HoekBrownFit> regress_hoek_brown(const StrengthData& data);

/// The constants of a rock mass.
struct RockMassConstants
{
  double m;
  double s;
  double a;
};

/// Constants of a rock mass of this geological strength index and disturbance D from 0 to 1 (Hoek, Carranza-Torres and Corkum
/// 2002).
RockMassConstants rock_mass_constants(double m_i, double strength_index, double disturbance);

/// m_i of intact rock by its strengths in compression: m of the intact form through these points, two of which suffice. None
/// without a confined one beside the uniaxial one, and where the deviator does not grow with the pressure.
std::optional<double> rock_constant(const std::vector<EnvelopePoint>& in_compression);
} // namespace feldspar

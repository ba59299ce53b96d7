#include "results/evaluation/rising_branch.h"

/// Strength, moduli and Poisson's ratios; all but the strength of tests whose stress is uniform.
namespace feldspar::evaluation
{
namespace
{
/// Slopes of the gauge.
template <typename Y>
Figure initial_slope(const RisingBranch& branch, const Y& y)
{
  return branch.slope_between(
    branch.of_initial_slope, [&](const CurveSample& row) { return branch.kind.sign * row.gauge_axial_strain; }, y);
}

double expansion(const RisingBranch& branch, const CurveSample& row)
{
  return -branch.kind.sign * row.gauge_lateral_strain;
}
} // namespace

Figure peak_stress(const RisingBranch& branch) { return known(branch.stress(branch.at_peak())); }

Figure strain_at_peak(const RisingBranch& branch) { return known(branch.strain(branch.at_peak())); }

Figure youngs_modulus_initial(const RisingBranch& branch)
{
  return initial_slope(branch, [&](const CurveSample& row) { return branch.stress(row); });
}

Figure youngs_modulus_tangent(const RisingBranch& branch)
{
  return branch.slope_between(
    {0.40, 0.60}, [&](const CurveSample& row) { return branch.strain(row); },
    [&](const CurveSample& row) { return branch.stress(row); });
}

Figure youngs_modulus_secant(const RisingBranch& branch)
{
  return known(0.5 * branch.peak_deviator /
               branch.at_share(0.5, [&](const CurveSample& row) { return branch.strain(row); }));
}

Figure poissons_ratio_initial(const RisingBranch& branch)
{
  return initial_slope(branch, [&](const CurveSample& row) { return expansion(branch, row); });
}

Figure poissons_ratio_secant(const RisingBranch& branch)
{
  return known(branch.at_share(0.5, [&](const CurveSample& row) { return expansion(branch, row); }) /
               branch.at_share(0.5, [&](const CurveSample& row) { return branch.kind.sign * row.gauge_axial_strain; }));
}
} // namespace feldspar::evaluation

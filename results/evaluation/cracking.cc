#include "results/evaluation.h"
#include "results/evaluation/rising_branch.h"

/// Crack stresses, numbers of cracks, and what the test left of the body.
namespace feldspar
{
namespace
{
constexpr const char* no_crack = "no crack before the peak";

/// Row at which the volume is smallest, if it grows again before the peak.
std::optional<std::size_t> most_contracted_row(const RisingBranch& branch)
{
  const auto row = std::ranges::min_element(branch.rows, {}, &CurveSample::gauge_volumetric_strain);
  if (row == branch.rows.begin() || row + 1 == branch.rows.end())
    return std::nullopt;
  return std::size_t(row - branch.rows.begin());
}

/// Stress at which a quantity lies furthest below the straight line from the start to a row, for there it begins to grow faster.
template <typename Value>
Figure stress_before_growth(const RisingBranch& branch, const std::size_t last, const Value& value,
                            const char* const never)
{
  const CurveSample& first = branch.rows.front();
  const double rise = branch.stress(branch.rows[last]) - branch.stress(first);
  if (!(rise > 0.0))
    return unknown("no load before the crack damage stress");
  const double slope = (value(branch.rows[last]) - value(first)) / rise;
  double furthest = 0.0;
  std::size_t at = 0;
  for (std::size_t k = 0; k <= last; ++k)
    {
      const double on_line = value(first) + slope * (branch.stress(branch.rows[k]) - branch.stress(first));
      if (const double distance = on_line - value(branch.rows[k]); distance > furthest)
        {
          furthest = distance;
          at = k;
        }
    }
  return at == 0 ? unknown(never) : known(branch.stress(branch.rows[at]));
}

/// The same up to the crack damage stress.
template <typename Value>
Figure initiation_before_damage(const RisingBranch& branch, const Value& value, const char* const never)
{
  const auto damage = most_contracted_row(branch);
  return damage ? stress_before_growth(branch, *damage, value, never) : unknown("needs the crack damage stress");
}

/// Number of the cracks of some kind up to the peak.
template <typename Is>
double n_up_to_peak(const RisingBranch& branch, const Is& is)
{
  return double(std::ranges::count_if(
    branch.record.cracks, [&](const Crack& crack) { return crack.step <= branch.at_peak().step && is(crack); }));
}

/// Number of cracks on grain boundaries, in a grain-based model.
double n_smooth_cracks(const RisingBranch& branch, const CrackKind kind)
{
  return n_up_to_peak(branch, [=](const Crack& crack) { return crack.on_smooth_joint && crack.kind == kind; });
}

Figure share_of_cracks(const RisingBranch& branch, const double n)
{
  const std::uint64_t all = branch.at_peak().n_cracks();
  return all > 0 ? known(n / double(all)) : unknown(no_crack);
}
} // namespace

std::optional<std::size_t> crack_initiation_row(const TestRecord& record, const std::size_t peak)
{
  const std::uint64_t at_peak = record.curve[peak].n_cracks();
  if (at_peak == 0)
    return std::nullopt;
  std::size_t row = 0;
  while (double(record.curve[row].n_cracks()) < 0.01 * double(at_peak))
    ++row;
  return row;
}

namespace evaluation
{
Figure crack_initiation_stress(const RisingBranch& branch)
{
  const auto row = crack_initiation_row(branch.record, branch.rows.size() - 1);
  return row ? known(branch.stress(branch.rows[*row])) : unknown(no_crack);
}

/// Lateral strain response: the stress at which the lateral expansion begins to grow faster. Needs no crack to be counted.
Figure crack_initiation_stress_lateral(const RisingBranch& branch)
{
  return initiation_before_damage(
    branch, [](const CurveSample& row) { return row.gauge_lateral_strain; },
    "lateral strain never lags behind a straight line");
}

/// The same by the hits of acoustic emission (the cumulative hits of Zhao et al. 2015).
Figure crack_initiation_stress_emission(const RisingBranch& branch)
{
  return initiation_before_damage(
    branch, [](const CurveSample& row) { return double(row.n_cracks()); }, "cracks never lag behind a straight line");
}

/// The same up to the peak by the energy that the hits released.
Figure crack_damage_stress_emission(const RisingBranch& branch)
{
  return stress_before_growth(
    branch, branch.rows.size() - 1, [](const CurveSample& row) { return row.energies.released; },
    "the released energy never lags behind a straight line");
}

/// Stress at which the volumetric strain, contracting at first, turns round.
Figure crack_damage_stress(const RisingBranch& branch)
{
  if (const auto row = most_contracted_row(branch))
    return known(branch.stress(branch.rows[*row]));
  return unknown(branch.at_peak().gauge_volumetric_strain < 0.0 ? "volumetric strain did not turn round before the peak"
                                                                : "the volume never contracted");
}

Figure post_peak_drop(const RisingBranch& branch)
{
  return known(1.0 - branch.stress(branch.record.curve.back()) / branch.stress(branch.at_peak()));
}

Figure residual_deviator_ratio(const RisingBranch& branch)
{
  return known(branch.deviator(branch.record.curve.back()) / branch.peak_deviator);
}

Figure n_tension_cracks_at_peak(const RisingBranch& branch) { return known(double(branch.at_peak().n_tension_cracks)); }

Figure n_shear_cracks_at_peak(const RisingBranch& branch) { return known(double(branch.at_peak().n_shear_cracks)); }

Figure shear_share_at_peak(const RisingBranch& branch)
{
  return share_of_cracks(branch, double(branch.at_peak().n_shear_cracks));
}

Figure n_smooth_tension_cracks_at_peak(const RisingBranch& branch)
{
  return known(n_smooth_cracks(branch, CrackKind::tension));
}

Figure n_smooth_shear_cracks_at_peak(const RisingBranch& branch)
{
  return known(n_smooth_cracks(branch, CrackKind::shear));
}

Figure smooth_tension_share_at_peak(const RisingBranch& branch)
{
  return share_of_cracks(branch, n_smooth_cracks(branch, CrackKind::tension));
}

Figure boundary_crack_share_at_peak(const RisingBranch& branch)
{
  return share_of_cracks(branch, n_up_to_peak(branch, [](const Crack& crack) { return crack.on_boundary; }));
}

/// Share of the first cracks of a disc near its pads, which tells where a disc that is to be split breaks first.
/// Hondros' tension across the loaded diameter, of a disc loaded over 20° at either end, is at least half of that in
/// the middle up to 0.68 of the radius (docs/theory.md §4.4). Single grains at a pad may crack before the disc does, so
/// that the first third of the cracks up to the peak counts.
Figure first_cracks_at_pads_share(const RisingBranch& branch)
{
  constexpr double middle_part = 0.68;
  constexpr std::ptrdiff_t share_of_first = 3;
  constexpr std::ptrdiff_t fewest = 8; // of a brittle disc some of them come after its peak
  const auto& cracks = branch.record.cracks;
  const auto up_to_peak =
    std::ranges::count_if(cracks, [&](const Crack& crack) { return crack.step <= branch.at_peak().step; });
  const auto n = std::min(std::ptrdiff_t(cracks.size()), std::max(fewest, up_to_peak / share_of_first));
  if (n == 0)
    return unknown("no crack");
  const auto axis = std::size_t(branch.record.dimension()) - 1;
  const double radius = 0.5 * branch.record.size[axis];
  const auto n_at_pads = std::count_if(cracks.begin(), cracks.begin() + n, [&](const Crack& crack) {
    return std::abs(crack.centroid[axis] - radius) > middle_part * radius;
  });
  return known(double(n_at_pads) / double(n));
}

Figure n_fragments(const TestRecord& record) { return known(double(record.fragments->n)); }

Figure largest_fragment_share(const TestRecord& record) { return known(record.fragments->largest_share); }
} // namespace evaluation
} // namespace feldspar

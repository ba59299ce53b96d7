#include "laboratory/named_entries.h"
#include "results/evaluation/rising_branch.h"

/// Figures of bodies with a notch (docs/theory.md §4.8).
namespace feldspar::evaluation
{
Figure fracture_toughness(const RisingBranch& branch)
{
  const NotchGeometry& notch = *branch.record.notch;
  return notch.is_valid
           ? known(notch.intensity_over_stress * branch.stress(branch.at_peak()))
           : unknown("the body lies outside of the range of the formula: a half disc has a toughness with " +
                     input_entries::notch_ratio.text() +
                     " from 0.4 to 0.6, a plate that is 1.2 times as long between its grips as it is wide");
}

/// The fracture energy from the work that the load did until it had fallen, over the ligament (RILEM 50-FMC 1985, the weight
/// of the body left out).
Figure fracture_energy(const RisingBranch& branch)
{
  constexpr double small_rest = 0.1; // of the peak: what is left of the work then is less than a hundredth
  const NotchGeometry& notch = *branch.record.notch;
  double work = 0.0;
  const auto& curve = branch.record.curve;
  for (std::size_t k = 1; k < curve.size(); ++k)
    {
      work += notch.work_over_stress * 0.5 * (branch.stress(curve[k]) + branch.stress(curve[k - 1])) *
              (branch.strain(curve[k]) - branch.strain(curve[k - 1]));
      if (k >= branch.rows.size() && branch.stress(curve[k]) < small_rest * branch.stress(branch.at_peak()))
        return known(work / notch.ligament_area);
    }
  return unknown("the load did not fall to a tenth of its peak; " + input_entries::stop_stress.text() +
                 " = 0.05 lets it");
}
} // namespace feldspar::evaluation

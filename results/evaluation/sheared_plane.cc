#include "laboratory/peak.h"
#include "results/evaluation/rising_branch.h"

namespace feldspar::evaluation
{
Figure normal_stress_at_peak(const RisingBranch& branch)
{
  return known(branch.record.normal_stiffness ? -branch.at_peak().lateral_stress : branch.record.confining_pressure);
}

Figure sliding_angle(const RisingBranch& branch)
{
  return known(std::atan(branch.stress(branch.at_peak()) / -branch.at_peak().lateral_stress));
}

/// The way of the platen that holds the normal stress is what the work of the walls is more than that of the shear stress:
/// dW = A (τ du - σ_n dv).
Figure dilation_angle(const RisingBranch& branch)
{
  const TestRecord& record = branch.record;
  const double width = record.size[0];
  const double area = width * (record.dimension() == 2 ? 1.0 : record.size[1]); // in the plane of a slice of 1 m
  const auto& curve = record.curve;
  std::vector<double> shear{0.0};
  std::vector<double> opening{0.0};
  std::size_t start = 0;
  while (mobilised(record, curve[start]) < share_of_strength * mobilised(record, branch.at_peak()))
    ++start;
  for (std::size_t k = start + 1; k < curve.size(); ++k)
    {
      if (-curve[k].lateral_stress < 0.5 * record.confining_pressure)
        return unknown("the platen lost half of the normal stress after the peak");
      const double du = width * (branch.strain(curve[k]) - branch.strain(curve[k - 1]));
      const double mean = 0.5 * (branch.stress(curve[k]) + branch.stress(curve[k - 1]));
      const double work = curve[k].energies.boundary_work - curve[k - 1].energies.boundary_work;
      shear.push_back(shear.back() + du);
      opening.push_back(opening.back() + (mean * du - work / area) / -curve[k].lateral_stress);
    }
  return shear.size() < 3 ? unknown("fewer than three rows of the curve from the strength to the end")
                          : known(std::atan(paired_moments(shear, opening).slope()));
}
} // namespace feldspar::evaluation

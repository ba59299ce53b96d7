#include "dem/flaws/smooth_planes.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <numeric>

namespace feldspar
{
std::string objection(const SmoothJointParameters& wanted)
{
  // Sliding would give more energy than it takes.
  if (std::tan(wanted.dilation_angle) <= wanted.friction)
    return "";
  constexpr double degree = std::numbers::pi / 180.0;
  return fmt::format("dilation must be at most the angle of friction, {:.3g} deg", std::atan(wanted.friction) / degree);
}

template <int dim>
void number_joints(Specimen<dim>& specimen)
{
  auto& numbers = specimen.joints.number;
  std::iota(numbers.begin(), numbers.end(), 0u);
  auto next = std::uint32_t(numbers.size());
  for (auto& joint : specimen.smooth_joints)
    joint.number = next++;
}

template <int dim>
void put_smooth_joints(Specimen<dim>& specimen, const std::vector<SmoothPlace<dim>>& places,
                       const SmoothJointParameters& wanted, const bool bonded)
{
  auto& joints = specimen.joints;
  std::vector<bool> is_smooth(joints.size(), false);
  for (const auto& place : places)
    {
      is_smooth[place.joint] = true;
      SmoothJoint<dim> joint;
      joint.grain_1 = joints.grain_1[place.joint];
      joint.grain_2 = joints.grain_2[place.joint];
      joint.area = place.area;
      joint.half_radius_difference = joints.half_radius_difference[place.joint];
      const Vector<dim> branch =
        at<dim>(specimen.grains.position, joint.grain_2) - at<dim>(specimen.grains.position, joint.grain_1);
      const double direction = branch.dot(place.normal) < 0.0 ? -1.0 : 1.0;
      for (int c = 0; c < dim; ++c)
        {
          joint.normal[c] = direction * place.normal[c];
          joint.branch[c] = branch[c];
        }
      joint.face = smooth_joint::face(wanted);
      joint.state.gap = joints.opening[place.joint];
      joint.state.bonded = bonded && !(joint.state.gap > 0.0); // a gap has nothing to bond
      specimen.smooth_joints.push_back(joint);
    }
  std::sort(specimen.smooth_joints.begin(), specimen.smooth_joints.end(),
            [](const auto& a, const auto& b) { return a.ends() < b.ends(); });
  std::vector<std::size_t> kept;
  for (std::size_t j = 0; j < joints.size(); ++j)
    if (!is_smooth[j])
      kept.push_back(j);
  joints.keep(kept);
  specimen.report.n_joints = specimen.n_joints();
  specimen.report.n_smooth_joints = specimen.smooth_joints.size();
  number_joints(specimen);
}

template <int dim>
void keep_apart(Specimen<dim>& specimen, const std::function<bool(const Vector<dim>&, const Vector<dim>&)>& cuts)
{
  auto& pairs = specimen.kept_apart;
  const auto& positions = specimen.grains.position;
  const double reach = 2.0 * specimen.grains.mean_radius();
  for (const auto& [one, two] : pairs_within(specimen.grains, reach))
    if (cuts(at<dim>(positions, one), at<dim>(positions, two)))
      pairs.emplace_back(one, two);
  std::sort(pairs.begin(), pairs.end());
  pairs.erase(std::unique(pairs.begin(), pairs.end()), pairs.end());
}

template void put_smooth_joints<2>(Specimen<2>&, const std::vector<SmoothPlace<2>>&, const SmoothJointParameters&,
                                   bool);
template void put_smooth_joints<3>(Specimen<3>&, const std::vector<SmoothPlace<3>>&, const SmoothJointParameters&,
                                   bool);
template void keep_apart<2>(Specimen<2>&, const std::function<bool(const Vector<2>&, const Vector<2>&)>&);
template void keep_apart<3>(Specimen<3>&, const std::function<bool(const Vector<3>&, const Vector<3>&)>&);
template void number_joints<2>(Specimen<2>&);
template void number_joints<3>(Specimen<3>&);
} // namespace feldspar

#include "dem/flaws/smooth_planes.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>

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
  std::ranges::sort(specimen.smooth_joints, {}, &SmoothJoint<dim>::ends);
  joints.keep_if([&](const std::size_t j) { return !is_smooth[j]; });
  specimen.report.n_joints = specimen.n_joints();
  specimen.report.n_smooth_joints = specimen.smooth_joints.size();
  specimen.number_joints();
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

template decltype(put_smooth_joints<2>) put_smooth_joints<2>;
template decltype(put_smooth_joints<3>) put_smooth_joints<3>;
template void keep_apart<2>(Specimen<2>&, const std::function<bool(const Vector<2>&, const Vector<2>&)>&);
template void keep_apart<3>(Specimen<3>&, const std::function<bool(const Vector<3>&, const Vector<3>&)>&);
} // namespace feldspar

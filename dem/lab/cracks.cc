#include "dem/lab/cracks.h"

#include "dem/specimen/mineral_sides.h"
#include "dem/storage/segment_place.h"

#include <algorithm>
#include <utility>

namespace feldspar
{
template <int dim>
Crack crack(const Dynamics<dim>& dynamics, const Break& event, const double axial_strain)
{
  const Specimen<dim>& body = dynamics.specimen();
  const auto& joints = body.joints;
  Crack result;
  result.kind = event.in_tension ? CrackKind::tension : CrackKind::shear;
  result.segment = event.segment;
  result.step = dynamics.n_steps();
  result.axial_strain = axial_strain;
  const BrokenJoint broken = dynamics.joint_of(event);
  result.joint = broken.number;
  result.on_smooth_joint = broken.is_smooth;
  SegmentPlace<dim> place;
  if (result.on_smooth_joint)
    {
      const auto& joint = body.smooth_joints[event.joint - joints.size()];
      const Vector<dim> branch = Eigen::Map<const Vector<dim>>(joint.branch.data());
      place = {at<dim>(body.grains.position, joint.grain_1) + share_of_grain_1(joint, branch) * branch,
               Eigen::Map<const Vector<dim>>(joint.normal.data()), joint.size(body.thickness)};
    }
  else
    place = segment_place<dim>(body.grains, joints, event.joint, event.segment);
  result.centroid = in_space<dim>(place.centroid);
  result.normal = in_space<dim>(place.normal);
  result.size = place.size;
  result.released_energy = event.released_energy;
  const MineralSides sides = mineral_sides(body, broken.ends.first, broken.ends.second);
  result.mineral_1 = sides.lower;
  result.mineral_2 = sides.higher;
  result.on_boundary = sides.on_boundary;
  return result;
}

template <int dim>
std::vector<CrackBetween> cracks_of(const Dynamics<dim>& dynamics, const std::vector<Break>& breaks,
                                    const double axial_strain)
{
  std::vector<CrackBetween> cracks;
  cracks.reserve(breaks.size());
  for (const Break& event : breaks)
    {
      const auto [one, two] = dynamics.joint_of(event).ends;
      cracks.push_back({crack(dynamics, event, axial_strain), one, two});
    }
  if (dynamics.sharing().is_shared() && dynamics.n_breaks() > 0)
    {
      cracks = dynamics.sharing().gathered(cracks);
      std::ranges::sort(cracks, {},
                        [](const CrackBetween& one) { return std::pair(one.crack.joint, one.crack.segment); });
    }
  return cracks;
}

template decltype(cracks_of<2>) cracks_of<2>;
template decltype(cracks_of<3>) cracks_of<3>;
template Crack crack<2>(const Dynamics<2>&, const Break&, double);
template Crack crack<3>(const Dynamics<3>&, const Break&, double);
} // namespace feldspar

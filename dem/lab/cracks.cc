#include "dem/lab/cracks.h"

#include "base/mapped.h"
#include "dem/specimen/mineral_sides.h"
#include "dem/storage/segment_place.h"

#include <algorithm>
#include <utility>

namespace feldspar
{
namespace
{
/// The record of a break: its place and normal as the grains stand now, at an axial strain of the test.
template <int dim>
CrackBetween crack(const Dynamics<dim>& dynamics, const Break& event, const double axial_strain)
{
  const Specimen<dim>& body = dynamics.specimen();
  const auto [number, ends, is_smooth] = dynamics.joint_of(event);
  SegmentPlace<dim> place;
  if (is_smooth)
    {
      const auto& joint = body.smooth_joints[event.joint - body.joints.size()];
      const Vector<dim> branch = Eigen::Map<const Vector<dim>>(joint.branch.data());
      place = {at<dim>(body.grains.position, joint.grain_1) + share_of_grain_1(joint, branch) * branch,
               Eigen::Map<const Vector<dim>>(joint.normal.data()), joint.size(body.thickness)};
    }
  else
    place = segment_place<dim>(body.grains, body.joints, event.joint, event.segment);
  const MineralSides sides = mineral_sides(body, ends.first, ends.second);
  return {{.kind = event.in_tension ? CrackKind::tension : CrackKind::shear,
           .joint = number,
           .segment = event.segment,
           .step = dynamics.n_steps(),
           .axial_strain = axial_strain,
           .centroid = in_space<dim>(place.centroid),
           .normal = in_space<dim>(place.normal),
           .size = place.size,
           .released_energy = event.released_energy,
           .on_smooth_joint = is_smooth,
           .mineral_1 = sides.lower,
           .mineral_2 = sides.higher,
           .on_boundary = sides.on_boundary},
          ends.first,
          ends.second};
}
} // namespace

template <int dim>
std::vector<CrackBetween> cracks_of(const Dynamics<dim>& dynamics, const std::vector<Break>& breaks,
                                    const double axial_strain)
{
  auto cracks = mapped<CrackBetween>(breaks, [&](const Break& event) { return crack(dynamics, event, axial_strain); });
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
} // namespace feldspar

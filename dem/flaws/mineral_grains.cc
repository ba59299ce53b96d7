#include "dem/flaws/mineral_grains.h"

#include "base/mapped.h"
#include "base/parameter_id.h"
#include "dem/flaws/smooth_planes.h"
#include "dem/minerals/cells.h"
#include "dem/specimen/parameters.h"

#include <fmt/format.h>

#include <algorithm>
#include <cstdint>
#include <set>
#include <vector>

namespace feldspar
{
namespace
{
template <int dim>
void check(const Specimen<dim>& specimen, const SmoothJointParameters& boundary, const ParameterId& id)
{
  if (specimen.is_periodic())
    throw ParameterError(id, fmt::format("a periodic specimen has no smooth joints; {} must be box or cylinder",
                                         in_words(parameter_id<&SpecimenParameters::shape>())));
  if (const std::string what = objection(boundary); !what.empty())
    throw ParameterError(parameters_id<SmoothJointParameters>(), what);
}

/// Puts a smooth joint at every bonded joint between two groups, with the normal of the plane between their centres.
template <int dim>
void join_groups_smoothly(Specimen<dim>& specimen, const std::vector<Vector<dim>>& centres,
                          const SmoothJointParameters& boundary)
{
  const auto& joints = specimen.joints;
  std::vector<SmoothPlace<dim>> places;
  for (std::size_t j = 0; j < joints.size(); ++j)
    {
      const std::uint32_t one = specimen.groups[joints.grain_1[j]];
      const std::uint32_t two = specimen.groups[joints.grain_2[j]];
      if (one != two && joints.holds(j))
        places.push_back({j, (centres[two] - centres[one]).normalized(), joints.face_area(j)});
    }
  put_smooth_joints(specimen, places, boundary, true);
}
} // namespace

template <int dim>
void put_in_mineral_grains(Specimen<dim>& specimen, const MineralGrainParameters& wanted,
                           const SmoothJointParameters& boundary)
{
  if (!wanted.mean_size)
    return;
  const ParameterId size = parameter_id<&MineralGrainParameters::mean_size>();
  if (!specimen.groups.empty())
    throw ParameterError(size, "the specimen has mineral grains or clumps already; leave it out");
  check(specimen, boundary, size);
  const auto cells = throw_cells(specimen, {{"mineral grain", *wanted.mean_size}}, RandomStream::mineral_grains, size);
  specimen.groups = cells_of_grains(specimen, cells);
  join_groups_smoothly(specimen, mapped<Vector<dim>>(cells, &Cell<dim>::centre), boundary);
}

template <int dim>
void join_minerals_smoothly(Specimen<dim>& specimen, const MineralParameters& wanted,
                            const SmoothJointParameters& boundary)
{
  check(specimen, boundary, parameter_id<&MineralParameters::form>());
  const auto n = specimen.groups.empty() ? 0 : *std::max_element(specimen.groups.begin(), specimen.groups.end()) + 1;
  std::vector<Vector<dim>> centres(n, Vector<dim>::Zero());
  std::vector<double> volume(n, 0.0);
  for (std::size_t i = 0; i < specimen.grains.size(); ++i)
    {
      const double own = grain_volume<dim>(specimen.grains.radius[i], specimen.thickness);
      centres[specimen.groups[i]] += own * at<dim>(specimen.grains.position, i);
      volume[specimen.groups[i]] += own;
    }
  for (std::size_t k = 0; k < n; ++k)
    if (volume[k] > 0.0)
      centres[k] /= volume[k];
  std::set<GrainPair> of_flaws;
  for (const SmoothJoint<dim>& joint : specimen.smooth_joints)
    of_flaws.insert(joint.ends());
  join_groups_smoothly(specimen, centres, boundary);
  for (SmoothJoint<dim>& joint : specimen.smooth_joints)
    if (!of_flaws.contains(joint.ends()))
      {
        const JointRatios ratios =
          boundary_ratios(wanted, specimen.mineral[joint.grain_1], specimen.mineral[joint.grain_2]);
        joint.face.normal_stiffness *= ratios.stiffness;
        joint.face.shear_stiffness *= ratios.stiffness;
        joint.face.friction *= ratios.friction;
        joint.face.bond.tensile_strength *= ratios.tensile_strength;
        joint.face.bond.cohesion *= ratios.cohesion;
      }
}

template void put_in_mineral_grains<2>(Specimen<2>&, const MineralGrainParameters&, const SmoothJointParameters&);
template void put_in_mineral_grains<3>(Specimen<3>&, const MineralGrainParameters&, const SmoothJointParameters&);
template void join_minerals_smoothly<2>(Specimen<2>&, const MineralParameters&, const SmoothJointParameters&);
template void join_minerals_smoothly<3>(Specimen<3>&, const MineralParameters&, const SmoothJointParameters&);
} // namespace feldspar

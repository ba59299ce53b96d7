#include "dem/specimen/specimen_part.h"

#include "base/mapped.h"

#include <cstdint>
#include <map>
#include <utility>

namespace feldspar
{
namespace
{
/// Numbers groups in the order in which they come; returns how many there are.
std::uint32_t number_without_gaps(std::vector<std::uint32_t>& groups)
{
  std::map<std::uint32_t, std::uint32_t> number;
  for (auto& group : groups)
    group = number.emplace(group, std::uint32_t(number.size())).first->second;
  return std::uint32_t(number.size());
}

/// Turned by a quarter, so that the axis `other` becomes `one`: (x, z) -> (z, W - x).
template <int dim>
Specimen<dim> with_axes_turned(Specimen<dim> specimen, const int one, const int other)
{
  const double width = specimen.size[one];
  const auto turn = [=](auto& components) {
    for (std::size_t i = 0; i < components[one].size(); ++i)
      components[other][i] = -std::exchange(components[one][i], components[other][i]);
  };
  turn(specimen.grains.position);
  for (double& x : specimen.grains.position[other])
    x += width;
  turn(specimen.joints.normal);
  if constexpr (dim == 3)
    turn(specimen.joints.tangent);
  for (auto& joint : specimen.smooth_joints)
    for (auto* vector : {&joint.normal, &joint.branch})
      (*vector)[other] = -std::exchange((*vector)[one], (*vector)[other]);
  for (auto& flaw : specimen.flaws)
    for (auto& point : flaw.outline)
      point[other] = width - std::exchange(point[one], point[other]);
  std::swap(specimen.size[one], specimen.size[other]);
  return specimen;
}
} // namespace

template <int dim>
Specimen<dim> part_of(Specimen<dim> specimen, const std::vector<bool>& kept)
{
  std::vector<std::uint32_t> left, new_number(kept.size());
  for (std::uint32_t i = 0; i < kept.size(); ++i)
    if (kept[i])
      {
        new_number[i] = std::uint32_t(left.size());
        left.push_back(i);
      }
  const auto renumber = [&](auto&... ends) { ((ends = new_number[ends]), ...); };
  specimen.grains = specimen.grains.chosen(left);

  auto& joints = specimen.joints;
  joints.keep_if([&](const std::size_t j) { return kept[joints.grain_1[j]] && kept[joints.grain_2[j]]; });
  for (std::size_t j = 0; j < joints.size(); ++j)
    renumber(joints.grain_1[j], joints.grain_2[j]);

  const auto leaves = [&](const auto& pair) { return !kept[pair.first] || !kept[pair.second]; };
  std::erase_if(specimen.smooth_joints, [&](const SmoothJoint<dim>& joint) { return leaves(joint.ends()); });
  for (auto& joint : specimen.smooth_joints)
    renumber(joint.grain_1, joint.grain_2);
  std::erase_if(specimen.kept_apart, leaves);
  for (auto& [one, two] : specimen.kept_apart)
    renumber(one, two);
  for (auto* const of_grains : {&specimen.groups, &specimen.mineral})
    if (!of_grains->empty())
      *of_grains = mapped<std::uint32_t>(left, [&](const std::uint32_t i) { return (*of_grains)[i]; });
  if (specimen.groups_are_rigid)
    specimen.report.n_clumps = number_without_gaps(specimen.groups);

  auto& report = specimen.report;
  report.n_grains = specimen.grains.size();
  report.n_joints = specimen.n_joints();
  report.n_smooth_joints = specimen.smooth_joints.size();
  if (report.n_grains == 0)
    return specimen;
  report.mean_radius = specimen.grains.mean_radius();
  report.resolution = specimen.size[0] / (2.0 * report.mean_radius);
  report.coordination_number = 2.0 * double(report.n_joints) / double(report.n_grains);
  return specimen;
}

template <int dim>
Specimen<dim> shifted(Specimen<dim> specimen, const Vector<dim>& way, const Vector<dim>& size)
{
  for (int c = 0; c < dim; ++c)
    for (double& x : specimen.grains.position[c])
      x += way[c];
  for (auto& flaw : specimen.flaws)
    for (auto& point : flaw.outline)
      point += way;
  specimen.size = size;
  specimen.report.resolution = size[0] / (2.0 * specimen.report.mean_radius);
  return specimen;
}

template <int dim>
Specimen<dim> laid_on_side(Specimen<dim> specimen)
{
  if constexpr (dim == 3)
    return with_axes_turned(std::move(specimen), 1, 2);
  else
    return specimen;
}

template <int dim>
Specimen<dim> quarter_turned(Specimen<dim> specimen)
{
  return with_axes_turned(std::move(specimen), 0, dim - 1);
}

template Specimen<2> shifted<2>(Specimen<2>, const Vector<2>&, const Vector<2>&);
template Specimen<3> shifted<3>(Specimen<3>, const Vector<3>&, const Vector<3>&);
template Specimen<2> laid_on_side<2>(Specimen<2>);
template Specimen<3> laid_on_side<3>(Specimen<3>);
template Specimen<2> quarter_turned<2>(Specimen<2>);
template Specimen<3> quarter_turned<3>(Specimen<3>);
template Specimen<2> part_of<2>(Specimen<2>, const std::vector<bool>&);
template Specimen<3> part_of<3>(Specimen<3>, const std::vector<bool>&);
} // namespace feldspar

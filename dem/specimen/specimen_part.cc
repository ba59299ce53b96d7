#include "dem/specimen/specimen_part.h"

#include <cstdint>
#include <limits>
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
} // namespace

template <int dim>
Specimen<dim> part_of(Specimen<dim> specimen, const std::vector<bool>& kept)
{
  const Grains<dim> whole = std::move(specimen.grains);
  constexpr auto outside = std::numeric_limits<std::uint32_t>::max();
  std::vector<std::uint32_t> new_number(whole.size(), outside);
  std::vector<double> radii, masses, inertias;
  Components<dim> positions;
  for (std::size_t i = 0; i < whole.size(); ++i)
    {
      if (!kept[i])
        continue;
      new_number[i] = std::uint32_t(radii.size());
      radii.push_back(whole.radius[i]);
      masses.push_back(whole.mass[i]);
      inertias.push_back(whole.moment_of_inertia[i]);
      for (int c = 0; c < dim; ++c)
        positions[c].push_back(whole.position[c][i]);
    }
  specimen.grains = {};
  specimen.grains.place(radii, positions);
  specimen.grains.mass = masses;
  specimen.grains.moment_of_inertia = inertias;

  auto& joints = specimen.joints;
  std::vector<std::size_t> kept_joints;
  for (std::size_t j = 0; j < joints.size(); ++j)
    if (kept[joints.grain_1[j]] && kept[joints.grain_2[j]])
      kept_joints.push_back(j);
  joints.keep(kept_joints);
  for (auto* ends : {&joints.grain_1, &joints.grain_2})
    for (auto& grain : *ends)
      grain = new_number[grain];

  const auto leaves = [&](const auto& pair) { return !kept[pair.first] || !kept[pair.second]; };
  std::erase_if(specimen.smooth_joints, [&](const SmoothJoint<dim>& joint) { return leaves(joint.ends()); });
  for (auto& joint : specimen.smooth_joints)
    {
      joint.grain_1 = new_number[joint.grain_1];
      joint.grain_2 = new_number[joint.grain_2];
    }
  std::erase_if(specimen.kept_apart, leaves);
  for (auto& [one, two] : specimen.kept_apart)
    {
      one = new_number[one];
      two = new_number[two];
    }
  for (auto* const of_grains : {&specimen.groups, &specimen.mineral})
    {
      std::vector<std::uint32_t> left;
      for (std::size_t i = 0; i < of_grains->size(); ++i)
        if (kept[i])
          left.push_back((*of_grains)[i]);
      *of_grains = left;
    }
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
    {
      // (x, y, z) -> (x, z, W - y).
      const double width = specimen.size[1];
      const auto turn = [](auto& components) {
        for (std::size_t i = 0; i < components[1].size(); ++i)
          components[2][i] = -std::exchange(components[1][i], components[2][i]);
      };
      turn(specimen.grains.position);
      for (double& z : specimen.grains.position[2])
        z += width;
      turn(specimen.joints.normal);
      turn(specimen.joints.tangent);
      for (auto& joint : specimen.smooth_joints)
        for (auto* vector : {&joint.normal, &joint.branch})
          (*vector)[2] = -std::exchange((*vector)[1], (*vector)[2]);
      for (auto& flaw : specimen.flaws)
        for (auto& point : flaw.outline)
          point[2] = width - std::exchange(point[1], point[2]);
      std::swap(specimen.size[1], specimen.size[2]);
    }
  return specimen;
}

template <int dim>
Specimen<dim> quarter_turned(Specimen<dim> specimen)
{
  constexpr int last = dim - 1;
  // (x, z) -> (z, W - x).
  const double width = specimen.size[0];
  const auto turn = [](auto& components) {
    for (std::size_t i = 0; i < components[0].size(); ++i)
      components[last][i] = -std::exchange(components[0][i], components[last][i]);
  };
  turn(specimen.grains.position);
  for (double& x : specimen.grains.position[last])
    x += width;
  turn(specimen.joints.normal);
  if constexpr (dim == 3)
    turn(specimen.joints.tangent);
  for (auto& joint : specimen.smooth_joints)
    for (auto* vector : {&joint.normal, &joint.branch})
      (*vector)[last] = -std::exchange((*vector)[0], (*vector)[last]);
  for (auto& flaw : specimen.flaws)
    for (auto& point : flaw.outline)
      point[last] = width - std::exchange(point[0], point[last]);
  std::swap(specimen.size[0], specimen.size[last]);
  return specimen;
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

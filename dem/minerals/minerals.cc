#include "dem/minerals/minerals.h"

#include "base/mapped.h"
#include "base/parameter_id.h"
#include "base/random.h"
#include "dem/minerals/cells.h"
#include "dem/minerals/mineral_map.h"
#include "dem/specimen/disjoint_sets.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <numeric>
#include <vector>

namespace feldspar
{
namespace
{
/// Lets grains at the boundaries of cells change to the cell beyond until no change brings the minerals nearer to their shares:
/// to one grain.
template <int dim>
void meet_shares(const Specimen<dim>& specimen, const std::vector<Mineral>& minerals,
                 const std::vector<Cell<dim>>& cells, std::vector<std::uint32_t>& cell_of)
{
  const auto& joints = specimen.joints;
  const auto volume_of = [&](const std::size_t grain) {
    return grain_volume<dim>(specimen.grains.radius[grain], specimen.thickness);
  };
  auto excess = mapped<double>(
    minerals, [&](const Mineral& mineral) { return -*mineral.share * specimen.grains.volume(specimen.thickness); });
  for (std::size_t i = 0; i < cell_of.size(); ++i)
    excess[cells[cell_of[i]].kind] += volume_of(i);
  std::vector<std::size_t> order(joints.size());
  std::iota(order.begin(), order.end(), std::size_t(0));
  Random(specimen.seed, RandomStream::shares).shuffle(order);
  // Each round takes a layer of grains at most, so that no cell grows by far more than the others.
  for (bool some_changed = true; some_changed;)
    {
      some_changed = false;
      std::vector<bool> has_changed(cell_of.size(), false);
      const auto change = [&](const std::size_t grain, const std::size_t neighbour) {
        double& from = excess[cells[cell_of[grain]].kind];
        double& to = excess[cells[cell_of[neighbour]].kind];
        const double volume = volume_of(grain);
        if (has_changed[grain] || has_changed[neighbour] ||
            std::abs(from - volume) + std::abs(to + volume) >= std::abs(from) + std::abs(to) - 1e-9 * volume)
          return;
        from -= volume;
        to += volume;
        cell_of[grain] = cell_of[neighbour];
        has_changed[grain] = some_changed = true;
      };
      for (const std::size_t j : order)
        if (cells[cell_of[joints.grain_1[j]]].kind != cells[cell_of[joints.grain_2[j]]].kind)
          {
            change(joints.grain_1[j], joints.grain_2[j]);
            change(joints.grain_2[j], joints.grain_1[j]);
          }
    }
}

template <int dim>
void fill_by_shares(Specimen<dim>& specimen, const std::vector<Mineral>& minerals)
{
  const auto kinds = mapped<CellKind>(minerals, [](const Mineral& one) {
    return CellKind{"mineral grain", one.size, one.name, *one.share, one.aspect_ratio, one.angle};
  });
  const auto cells =
    throw_cells(specimen, kinds, RandomStream::mineral_grains, parameter_id<&MineralParameters::table>());
  specimen.groups = cells_of_grains(specimen, cells);
  meet_shares(specimen, minerals, cells, specimen.groups);
  for (const std::uint32_t cell : specimen.groups)
    specimen.mineral.push_back(std::uint32_t(cells[cell].kind));
}

/// Mineral grains are the grains of one mineral that joints connect; numbered in the order of their first grains.
template <int dim>
void fill_by_map(Specimen<dim>& specimen, const MineralParameters& wanted)
{
  specimen.mineral = minerals_of_grains(specimen, wanted);
  const auto& joints = specimen.joints;
  DisjointSets connected(specimen.grains.size());
  for (std::size_t j = 0; j < joints.size(); ++j)
    if (specimen.mineral[joints.grain_1[j]] == specimen.mineral[joints.grain_2[j]])
      connected.merge(joints.grain_1[j], joints.grain_2[j]);
  std::vector<std::uint32_t> number_of_root(specimen.grains.size());
  std::uint32_t n = 0;
  for (std::uint32_t i = 0; i < specimen.grains.size(); ++i)
    {
      const std::uint32_t root = connected.root(i); // its smallest member, so numbered before
      if (root == i)
        number_of_root[i] = n++;
      specimen.groups.push_back(number_of_root[root]);
    }
}

/// Calls f(joint, ratios) for each joint.
template <int dim, typename F>
void for_each_ratio(const Specimen<dim>& specimen, const MineralParameters& wanted, const F& f)
{
  const std::size_t n = wanted.minerals.size();
  std::vector<JointRatios> boundary;
  for (std::size_t one = 0; one < n; ++one)
    for (std::size_t two = 0; two < n; ++two)
      boundary.push_back(boundary_ratios(wanted, one, two));
  const auto& joints = specimen.joints;
  for (std::size_t j = 0; j < joints.size(); ++j)
    {
      const std::uint32_t grain_1 = joints.grain_1[j], grain_2 = joints.grain_2[j];
      const std::uint32_t one = specimen.mineral[grain_1], two = specimen.mineral[grain_2];
      f(j,
        specimen.groups[grain_1] == specimen.groups[grain_2] ? wanted.minerals[one].within : boundary[one * n + two]);
    }
}

/// Multiplies the properties of the joints by their ratios.
template <int dim>
void scale_joints(Specimen<dim>& specimen, const MineralParameters& wanted)
{
  auto& joints = specimen.joints;
  for_each_ratio(specimen, wanted, [&](const std::size_t j, const JointRatios& ratios) {
    joints.normal_stiffness[j] *= ratios.stiffness;
    joints.shear_stiffness[j] *= ratios.stiffness;
    joints.further_friction[j] = (ratios.friction - 1.0) * joints.friction;
    for (unsigned int i = 0; i < joints.n_segments; ++i)
      {
        joints.tensile_strength[joints.segment(i, j)] *= ratios.tensile_strength;
        joints.cohesion[joints.segment(i, j)] *= ratios.cohesion;
      }
  });
}

/// Gives the grains the masses of their minerals; the bulk density follows.
template <int dim>
void scale_masses(Specimen<dim>& specimen, const std::vector<Mineral>& minerals)
{
  auto& grains = specimen.grains;
  const double before = std::accumulate(grains.mass.begin(), grains.mass.end(), 0.0);
  for (std::size_t i = 0; i < grains.size(); ++i)
    {
      const double ratio =
        minerals[specimen.mineral[i]].density.value_or(specimen.bulk_density) / specimen.bulk_density;
      grains.mass[i] *= ratio;
      grains.moment_of_inertia[i] *= ratio;
    }
  specimen.bulk_density *= std::accumulate(grains.mass.begin(), grains.mass.end(), 0.0) / before;
}

/// The stiffness ratio of two in series.
double series(const double one, const double two) { return one == two ? one : 2.0 * one * two / (one + two); }
} // namespace

JointRatios boundary_ratios(const MineralParameters& wanted, const std::size_t one, const std::size_t two)
{
  const JointRatios& a = wanted.minerals[one].within;
  const JointRatios& b = wanted.minerals[two].within;
  JointRatios ratios{series(a.stiffness, b.stiffness), std::min(a.tensile_strength, b.tensile_strength),
                     std::min(a.cohesion, b.cohesion), std::min(a.friction, b.friction)};
  for (const MineralBoundary& given : wanted.boundaries)
    if ((given.one == wanted.minerals[one].name && given.two == wanted.minerals[two].name) ||
        (given.one == wanted.minerals[two].name && given.two == wanted.minerals[one].name))
      ratios = {given.stiffness.value_or(ratios.stiffness), given.tensile_strength.value_or(ratios.tensile_strength),
                given.cohesion.value_or(ratios.cohesion), given.friction.value_or(ratios.friction)};
  ratios.tensile_strength *= wanted.boundary_strength;
  ratios.cohesion *= wanted.boundary_strength;
  return ratios;
}

template <int dim>
void put_in_minerals(Specimen<dim>& specimen, const MineralParameters& wanted)
{
  if (wanted.minerals.empty())
    return;
  if (!specimen.groups.empty())
    throw ParameterError(parameter_id<&MineralParameters::table>(), wanted.table,
                         "the specimen has minerals, mineral grains or clumps already; leave it out");
  if (wanted.map)
    fill_by_map(specimen, wanted);
  else
    fill_by_shares(specimen, wanted.minerals);
  for (const Mineral& mineral : wanted.minerals)
    specimen.minerals.push_back({mineral.name, mineral.colour});
  scale_joints(specimen, wanted);
  scale_masses(specimen, wanted.minerals);
}

template <int dim>
Specimen<dim> with_one_stiffness(Specimen<dim> specimen, const MineralParameters& wanted)
{
  auto& joints = specimen.joints;
  for_each_ratio(specimen, wanted, [&](const std::size_t j, const JointRatios& ratios) {
    joints.normal_stiffness[j] /= ratios.stiffness;
    joints.shear_stiffness[j] /= ratios.stiffness;
  });
  return specimen;
}

template Specimen<2> with_one_stiffness<2>(Specimen<2>, const MineralParameters&);
template Specimen<3> with_one_stiffness<3>(Specimen<3>, const MineralParameters&);
template void put_in_minerals<2>(Specimen<2>&, const MineralParameters&);
template void put_in_minerals<3>(Specimen<3>&, const MineralParameters&);
} // namespace feldspar

#include "dem/genesis/coring.h"

#include "dem/genesis/joint_installation.h"
#include "dem/specimen/disjoint_sets.h"
#include "dem/specimen/specimen_part.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <functional>
#include <map>
#include <numeric>
#include <string>
#include <utility>
#include <vector>

namespace feldspar
{
namespace
{
template <int dim>
using Place = std::array<int, dim>;

/// Order in which the elements of a face follow each other when it is seen from its other grain: the normal is turned
/// round and t_1 kept in space, so that t_2 turns round; in the plane t turns round.
template <int dim>
std::vector<unsigned int> mirrored_elements(const std::vector<FaceElement<dim>>& elements)
{
  std::vector<unsigned int> order;
  for (const auto& element : elements)
    {
      auto mirrored = element.offset;
      mirrored[dim - 2] = -mirrored[dim - 2];
      const auto miss = [&](const FaceElement<dim>& other) {
        double sum = 0.0;
        for (std::size_t c = 0; c < mirrored.size(); ++c)
          sum += std::abs(other.offset[c] - mirrored[c]);
        return sum;
      };
      order.push_back(unsigned(std::ranges::min_element(elements, {}, miss) - elements.begin()));
    }
  return order;
}

/// Names grain 2 of a joint at rest first.
template <int dim>
void turn_round(Joints<dim>& joints, const std::size_t j, const std::vector<unsigned int>& mirrored)
{
  std::swap(joints.grain_1[j], joints.grain_2[j]);
  for (auto& component : joints.normal)
    component[j] = -component[j];
  joints.half_radius_difference[j] = -joints.half_radius_difference[j];
  joints.visit_per_segment([&](const std::string&, auto& row) {
    std::vector<double> before;
    for (unsigned int i = 0; i < joints.n_segments; ++i)
      before.push_back(row[joints.segment(i, j)]);
    for (unsigned int i = 0; i < joints.n_segments; ++i)
      row[joints.segment(i, j)] = before[mirrored[i]];
  });
}
} // namespace

template <int dim>
Specimen<dim> repeated(const Specimen<dim>& cell, const std::array<unsigned int, dim>& n_cells)
{
  const std::size_t n_grains = cell.grains.size();
  const std::size_t n_joints = cell.joints.size();
  std::vector<Place<dim>> places{Place<dim>{}}; // of the copies, x fastest
  const auto number_of = [&](const Place<dim>& place) {
    std::size_t number = 0;
    for (int c = dim - 1; c >= 0; --c)
      number = number * n_cells[c] + std::size_t(place[c]);
    return number;
  };
  const std::size_t n_copies =
    std::accumulate(n_cells.begin(), n_cells.end(), std::size_t(1), std::multiplies<std::size_t>());
  while (places.size() < n_copies)
    {
      Place<dim> next = places.back();
      for (int c = 0; ++next[c] == int(n_cells[c]); ++c)
        next[c] = 0;
      places.push_back(next);
    }

  Specimen<dim> all = cell;
  for (int c = 0; c < dim; ++c)
    all.size[c] = cell.size[c] * n_cells[c];

  std::vector<double> radii;
  Components<dim> positions;
  for (const auto& place : places)
    for (std::size_t i = 0; i < n_grains; ++i)
      {
        radii.push_back(cell.grains.radius[i]);
        for (int c = 0; c < dim; ++c)
          positions[c].push_back(cell.grains.position[c][i] + place[c] * cell.size[c]);
      }
  all.grains.place(radii, positions);
  for (std::size_t k = 0; k < n_copies * n_grains; ++k)
    {
      all.grains.mass[k] = cell.grains.mass[k % n_grains];
      all.grains.moment_of_inertia[k] = cell.grains.moment_of_inertia[k % n_grains];
    }

  // Joints and segments are the same in each copy.
  Joints<dim> of_cell = cell.joints;
  Joints<dim>& joints = all.joints;
  joints.resize_all(n_copies * n_joints);
  std::map<std::string, std::vector<double>> rows;
  const auto note = [&](const std::string& name, auto& row) { rows[name].assign(row.begin(), row.end()); };
  of_cell.visit_per_joint(note);
  of_cell.visit_per_segment(note);
  joints.visit_per_joint([&](const std::string& name, auto& row) {
    const std::vector<double>& of_joints = rows[name];
    for (std::size_t j = 0; j < joints.size(); ++j)
      row[j] = of_joints[j % n_joints];
  });
  joints.visit_per_segment([&](const std::string& name, auto& row) {
    const std::vector<double>& of_segments = rows[name];
    for (unsigned int i = 0; i < joints.n_segments; ++i)
      for (std::size_t j = 0; j < joints.size(); ++j)
        row[joints.segment(i, j)] = of_segments[of_cell.segment(i, j % n_joints)];
  });

  const auto mirrored = mirrored_elements<dim>(joints.elements);
  for (std::size_t k = 0; k < n_copies; ++k)
    for (std::size_t j = 0; j < n_joints; ++j)
      {
        const auto second = cell.second_of(j);
        Place<dim> place = places[k];
        for (int c = 0; c < dim; ++c)
          {
            const int n = int(n_cells[c]);
            place[c] = ((place[c] + second.boxes[c]) % n + n) % n;
          }
        const std::size_t joint = k * n_joints + j;
        joints.grain_1[joint] = std::uint32_t(k * n_grains + cell.joints.grain_1[j]);
        joints.grain_2[joint] = std::uint32_t(number_of(place) * n_grains + second.owner);
        joints.number[joint] = std::uint32_t(joint);
        if (joints.grain_1[joint] > joints.grain_2[joint])
          turn_round(joints, joint, mirrored);
      }
  all.report.n_grains = all.grains.size();
  all.report.n_joints = joints.size();
  all.report.resolution *= n_cells[0];
  return all;
}

template <int dim>
Specimen<dim> cored(Specimen<dim> cell, const BodyShape shape)
{
  const std::size_t n = cell.grains.size();
  std::vector<bool> lies_inside(n);
  for (std::size_t i = 0; i < n; ++i)
    lies_inside[i] =
      shape != BodyShape::cylinder || cell.distance_from_axis(at<dim>(cell.grains.position, i)) < 0.5 * cell.size[0];

  DisjointSets groups(n);
  std::vector<bool> is_cut(n, false); // lost a joint
  std::vector<std::size_t> whole;     // joints
  std::size_t n_cut = 0;
  const PeriodicImage<dim> here{};
  for (std::size_t j = 0; j < cell.joints.size(); ++j)
    {
      const auto second = cell.second_of(j);
      const std::uint32_t first = cell.joints.grain_1[j];
      if (second.boxes == here.boxes && lies_inside[first] && lies_inside[second.owner])
        {
          groups.merge(first, second.owner);
          whole.push_back(j);
        }
      else
        {
          n_cut += lies_inside[first] || lies_inside[second.owner];
          is_cut[first] = is_cut[second.owner] = true;
        }
    }

  // The body is the largest group; others that were cut off are chips. A grain that never had a joint stays in its void.
  std::vector<bool> has_cut(n, false);
  for (std::uint32_t i = 0; i < n; ++i)
    if (is_cut[i])
      has_cut[groups.root(i)] = true;
  const std::uint32_t body = groups.largest();
  std::vector<bool> stays(n, false);
  std::size_t n_removed = 0;
  for (std::uint32_t i = 0; i < n; ++i)
    if (lies_inside[i])
      {
        const std::uint32_t group = groups.root(i);
        stays[i] = group == body || !has_cut[group];
        n_removed += !stays[i];
      }
  cell.joints.keep(whole);
  Specimen<dim> core = part_of(std::move(cell), stays);
  core.shape = shape;
  for (std::size_t j = 0; j < core.joints.size(); ++j)
    core.joints.number[j] = std::uint32_t(j);
  installation::fill_report(core, installation::pair_gaps(core, 0.0));
  core.report.n_cut_joints = n_cut;
  core.report.n_removed_grains = n_removed;
  return core;
}

template Specimen<2> repeated<2>(const Specimen<2>&, const std::array<unsigned int, 2>&);
template Specimen<3> repeated<3>(const Specimen<3>&, const std::array<unsigned int, 3>&);
template Specimen<2> cored<2>(Specimen<2>, BodyShape);
template Specimen<3> cored<3>(Specimen<3>, BodyShape);
} // namespace feldspar

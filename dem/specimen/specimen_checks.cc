#include "base/input_error.h"
#include "base/quoted.h"
#include "dem/specimen/specimen_file.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <variant>
#include <vector>

namespace feldspar
{
namespace
{
void require(const bool holds, const char* otherwise)
{
  if (!holds)
    throw InputError(otherwise);
}

/// Returns whether a value lies in [low, high]; false for what is not a number.
bool lies(const double value, const double low, const double high) { return value >= low && value <= high; }

template <typename Values>
bool all_lie(const Values& values, const double low, const double high)
{
  return std::ranges::all_of(values, [=](const double value) { return lies(value, low, high); });
}

constexpr double smallest = std::numeric_limits<double>::min();
constexpr double largest = std::numeric_limits<double>::max();

template <int dim>
void check_grains(const Specimen<dim>& specimen)
{
  const auto& grains = specimen.grains;
  require(grains.size() > 0 && grains.size() == specimen.report.n_grains && grains.mass.size() == grains.size(),
          "grains are missing");
  for (int c = 0; c < dim; ++c)
    {
      require(grains.position[c].size() == grains.size(), "grains are missing");
      require(all_lie(grains.position[c], -specimen.size[c], 2.0 * specimen.size[c]), "a grain lies far from its box");
    }
  require(all_lie(grains.radius, smallest, specimen.size.maxCoeff()) && all_lie(grains.mass, smallest, largest),
          "a grain has no positive radius and mass, or does not fit into its box");
  const auto [least, most] = std::minmax_element(grains.radius.begin(), grains.radius.end());
  require(lies(specimen.report.mean_radius, 0.99 * *least, 1.01 * *most), "its mean radius is not that of its grains");
}

template <int dim>
void check_joints(const Specimen<dim>& specimen)
{
  const auto& joints = specimen.joints;
  std::visit(
    [](const auto& law) {
      if constexpr (requires { law.is_possible(); })
        require(law.is_possible(), "a parameter of its joint law is not possible");
    },
    joints.law);
  const std::size_t n = joints.size();
  require(specimen.n_joints() == specimen.report.n_joints && joints.grain_2.size() == n && joints.number.size() == n,
          "joints are missing");
  std::vector<bool> is_taken(n, false);
  for (std::size_t j = 0; j < n; ++j)
    {
      require(joints.grain_1[j] < specimen.grains.size() && joints.grain_2[j] < specimen.grains.size() &&
                (joints.grain_1[j] < joints.grain_2[j] ||
                 (specimen.is_periodic() && joints.grain_1[j] == joints.grain_2[j])), // its own image
              "a joint names a grain that is not there");
      require(joints.number[j] < n && !is_taken[joints.number[j]], "two joints have one number");
      is_taken[joints.number[j]] = true;
      const Vector<dim> normal = at<dim>(joints.normal, j);
      require(lies(normal.norm(), 1.0 - 1e-6, 1.0 + 1e-6), "a joint has no direction");
      // Neighbours in the box or across one of its sides.
      const Vector<dim> branch = (joints.rest_distance[j] + joints.opening[j]) * normal;
      require((branch.array().abs() <= 2.0 * specimen.size.array()).all(), "a joint leads out of its box");
    }
  const double edge = specimen.size.maxCoeff();
  require(all_lie(joints.normal_stiffness, smallest, largest) && all_lie(joints.shear_stiffness, 0.0, largest) &&
            all_lie(joints.half_length, smallest, edge) && all_lie(joints.rest_distance, smallest, 2.0 * edge),
          "a joint has no positive stiffness and size");
  require(std::all_of(joints.bonded.begin(), joints.bonded.end(), [](const double b) { return b == 0.0 || b == 1.0; }),
          "a segment is neither bonded nor broken");
  require(all_lie(joints.tensile_strength, 0.0, largest) && all_lie(joints.cohesion, 0.0, largest),
          "a segment has a negative strength");
}

template <int dim>
void check_clumps(const Specimen<dim>& specimen)
{
  const auto& group = specimen.groups;
  if (!specimen.groups_are_rigid)
    return;
  require(dim == 2 && !specimen.is_periodic() && specimen.smooth_joints.empty(), "it has clumps, which it cannot have");
  std::vector<bool> has_members(group.size(), false);
  for (const auto g : group)
    {
      require(g < group.size(), "a clump is not there");
      has_members[g] = true;
    }
  require(group.size() == specimen.grains.size() && specimen.report.n_clumps <= group.size() &&
            std::size_t(std::ranges::count(has_members, true)) == specimen.report.n_clumps &&
            std::size_t(std::ranges::find(has_members, false) - has_members.begin()) == specimen.report.n_clumps,
          "clumps are missing");
  for (std::size_t j = 0; j < specimen.joints.size(); ++j)
    require(group[specimen.joints.grain_1[j]] != group[specimen.joints.grain_2[j]], "a joint lies inside a clump");
}

template <int dim>
void check_minerals(const Specimen<dim>& specimen)
{
  if (specimen.minerals.empty())
    return;
  require(
    specimen.mineral.size() == specimen.grains.size() && specimen.groups.size() == specimen.grains.size() &&
      std::ranges::all_of(specimen.mineral, [&](const auto mineral) { return mineral < specimen.minerals.size(); }),
    "a grain has no mineral");
  require(all_lie(specimen.joints.further_friction, -specimen.joints.friction, largest),
          "a joint has a negative friction");
  for (const MineralName& mineral : specimen.minerals)
    require(is_plain_name(mineral.name), "a mineral has no name");
}

template <int dim>
void check_smooth_joints(const Specimen<dim>& specimen)
{
  const std::size_t n_grains = specimen.grains.size();
  const auto is_pair = [&](const GrainPair& pair) { return pair.first < pair.second && pair.second < n_grains; };
  require(specimen.groups.empty() || specimen.groups.size() == n_grains, "mineral grains are missing");
  require(std::ranges::all_of(specimen.kept_apart, is_pair) && std::ranges::is_sorted(specimen.kept_apart),
          "grains are kept apart that are not there");
  const double edge = specimen.size.maxCoeff();
  GrainPair last{0, 0};
  for (const auto& joint : specimen.smooth_joints)
    {
      require(is_pair(joint.ends()) && joint.ends() > last && joint.number >= specimen.joints.size(),
              "a smooth joint names a grain that is not there, or comes twice");
      last = joint.ends();
      const auto& [k_n, k_s, friction, dilation, bond] = joint.face;
      require(lies(k_n, smallest, largest) && lies(k_s, smallest, largest) && lies(friction, 0.0, largest) &&
                lies(dilation, 0.0, friction) && lies(bond.tensile_strength, 0.0, largest) &&
                lies(bond.cohesion, 0.0, largest) && lies(bond.friction_slope, 0.0, largest) &&
                lies(joint.area, smallest, largest) && lies(joint.state.gap, -edge, edge) &&
                lies(std::abs(joint.half_radius_difference), 0.0, edge),
              "a smooth joint has no possible stiffness, strength or size");
      const Vector<dim> normal = Eigen::Map<const Vector<dim>>(joint.normal.data());
      const Vector<dim> branch = Eigen::Map<const Vector<dim>>(joint.branch.data());
      require(lies(normal.norm(), 1.0 - 1e-6, 1.0 + 1e-6) && lies(branch.norm(), smallest, 2.0 * edge),
              "a smooth joint has no direction");
    }
}
} // namespace

template <int dim>
void check_specimen(const Specimen<dim>& specimen)
{
  require(all_lie(specimen.size, smallest, largest) && lies(specimen.thickness, smallest, largest) &&
            lies(specimen.bulk_density, 0.0, largest),
          "its size or density is not positive");
  const auto& contact = specimen.particle_contact;
  require(lies(contact.modulus, 0.0, largest) && lies(contact.stiffness_ratio, 0.0, largest) &&
            lies(contact.friction, 0.0, largest) && lies(specimen.joints.thickness, smallest, largest) &&
            lies(specimen.joints.friction, 0.0, largest) && lies(specimen.joints.friction_slope, 0.0, largest),
          "a parameter of its contacts is negative or not a number");
  check_grains(specimen);
  check_joints(specimen);
  check_smooth_joints(specimen);
  check_minerals(specimen);
  check_clumps(specimen);
}

template void check_specimen<2>(const Specimen<2>&);
template void check_specimen<3>(const Specimen<3>&);
} // namespace feldspar

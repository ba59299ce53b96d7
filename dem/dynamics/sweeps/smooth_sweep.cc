#include "dem/dynamics/sweeps/smooth_sweep.h"

#include "base/parallel.h"
#include "dem/laws/contact_motion.h"

#include <Eigen/Geometry>

#include <algorithm>
#include <cstdint>

namespace feldspar
{
namespace
{
template <int dim>
Vector<dim> as_vector(const std::array<double, dim>& values)
{
  return Eigen::Map<const Vector<dim>>(values.data());
}

/// φ × r.
template <int dim>
Vector<dim> turned_by(const Rotation<dim>& turn, const Vector<dim>& arm)
{
  if constexpr (dim == 2)
    return turn[0] * Vector<2>(-arm[1], arm[0]);
  else
    return turn.cross(arm);
}

/// r × F.
template <int dim>
Rotation<dim> couple_of(const Vector<dim>& arm, const Vector<dim>& force)
{
  if constexpr (dim == 2)
    return Rotation<2>(arm[0] * force[1] - arm[1] * force[0]);
  else
    return arm.cross(force);
}

/// Carries one over a step; whether it broke, and how.
template <int dim>
smooth_joint::Update<dim> carry(SmoothJoint<dim>& joint, const Grains<dim>& grains, const double dt)
{
  const Vector<dim> before = as_vector<dim>(joint.branch);
  const Vector<dim> now = at<dim>(grains.position, joint.grain_2) - at<dim>(grains.position, joint.grain_1);
  const Rotation<dim> turn_1 = dt * at<n_rotations<dim>>(grains.spin, joint.grain_1);
  const Rotation<dim> turn_2 = dt * at<n_rotations<dim>>(grains.spin, joint.grain_2);
  // Relative motion of the two sides at the point where they meet: x_c = x_1 + s d. A rigid turn of the pair gives
  // none, because the branch at the middle of the step turns with it.
  const Vector<dim> mean = 0.5 * (before + now);
  const double s = share_of_grain_1(joint, mean);
  const Vector<dim> motion = now - before - turned_by<dim>(turn_1, s * mean) - turned_by<dim>(turn_2, (1.0 - s) * mean);

  const Vector<dim> normal = as_vector<dim>(joint.normal);
  const auto axes = plane_axes<dim>(normal);
  std::array<double, dim - 1> slip;
  for (int c = 0; c < dim - 1; ++c)
    slip[c] = motion.dot(axes[c]);
  const double opening = motion.dot(normal);
  const auto update = smooth_joint::update<dim>(joint.face, joint.state, opening, slip);

  joint.state = update.state;
  joint.opening += opening;
  for (int c = 0; c < dim - 1; ++c)
    joint.slip[c] += slip[c];
  joint.slip_energy += joint.area * update.slip_energy;
  Vector<dim> force = -joint.area * smooth_joint::normal_stress(joint.face, joint.state) * normal;
  for (int c = 0; c < dim - 1; ++c)
    force += joint.area * joint.state.shear_stress[c] * axes[c];
  const double share = share_of_grain_1(joint, now);
  const Rotation<dim> couple_1 = couple_of<dim>(share * now, -force);
  const Rotation<dim> couple_2 = couple_of<dim>((share - 1.0) * now, force);
  for (int c = 0; c < dim; ++c)
    {
      joint.branch[c] = now[c];
      joint.force[c] = force[c];
    }
  for (int c = 0; c < n_rotations<dim>; ++c)
    {
      joint.couple_1[c] = couple_1[c];
      joint.couple_2[c] = couple_2[c];
    }
  return update;
}
} // namespace

template <int dim>
std::vector<Break> sweep_smooth_joints(Specimen<dim>& body, const double dt)
{
  auto& joints = body.smooth_joints;
  const std::size_t n_others = body.joints.size();
  std::vector<std::vector<Break>> breaks(n_blocks(joints.size()));
  for_each_block(joints.size(), [&](const std::size_t block, const std::size_t begin, const std::size_t end) {
    for (std::size_t k = begin; k < end; ++k)
      {
        const auto update = carry(joints[k], body.grains, dt);
        if (update.tension_break || update.shear_break)
          breaks[block].push_back(
            {std::uint32_t(n_others + k), 0, update.tension_break, joints[k].area * update.released_energy});
      }
  });
  std::vector<Break> all;
  for (const auto& of_block : breaks)
    all.insert(all.end(), of_block.begin(), of_block.end());
  std::ranges::sort(all, {}, [&](const Break& event) { return joints[event.joint - n_others].number; });
  return all;
}

template <int dim>
void add_smooth_forces(Specimen<dim>& body)
{
  auto& grains = body.grains;
  for (const auto& joint : body.smooth_joints)
    {
      for (int c = 0; c < dim; ++c)
        {
          grains.force[c][joint.grain_1] -= joint.force[c];
          grains.force[c][joint.grain_2] += joint.force[c];
        }
      for (int c = 0; c < n_rotations<dim>; ++c)
        {
          grains.couple[c][joint.grain_1] += joint.couple_1[c];
          grains.couple[c][joint.grain_2] += joint.couple_2[c];
        }
    }
}

template <int dim>
void add_smooth_energies(const Specimen<dim>& body, const GrainRange& these, ExactSum& strain, ExactSum& slip)
{
  for (const auto& joint : body.smooth_joints)
    if (these.has(joint.grain_1))
      {
        slip.add(joint.slip_energy);
        strain.add(joint.stored_energy());
      }
}

template <int dim>
std::vector<EndedSmoothJoint> remove_ended_smooth_joints(Specimen<dim>& body)
{
  const auto& grains = body.grains;
  std::vector<EndedSmoothJoint> ended;
  std::erase_if(body.smooth_joints, [&](const SmoothJoint<dim>& joint) {
    if (smooth_joint::acts(joint.state))
      return false;
    const double radius_1 = grains.radius[joint.grain_1];
    const double radius_2 = grains.radius[joint.grain_2];
    const double reach = radius_1 + radius_2;
    // Sides along a flaw stay smooth however far they have slid; the opening alone ends it.
    const bool is_lost = (at<dim>(grains.position, joint.grain_2) - at<dim>(grains.position, joint.grain_1)).norm() >
                           reach + std::min(radius_1, radius_2) &&
                         !std::binary_search(body.kept_apart.begin(), body.kept_apart.end(), joint.ends());
    const bool ends = joint.opening > reach || is_lost;
    if (ends)
      ended.push_back({joint.ends(), joint.slip_energy + joint.stored_energy()});
    return ends;
  });
  return ended;
}

template std::vector<Break> sweep_smooth_joints<2>(Specimen<2>&, double);
template std::vector<Break> sweep_smooth_joints<3>(Specimen<3>&, double);
template void add_smooth_forces<2>(Specimen<2>&);
template void add_smooth_forces<3>(Specimen<3>&);
template void add_smooth_energies<2>(const Specimen<2>&, const GrainRange&, ExactSum&, ExactSum&);
template void add_smooth_energies<3>(const Specimen<3>&, const GrainRange&, ExactSum&, ExactSum&);
template std::vector<EndedSmoothJoint> remove_ended_smooth_joints<2>(Specimen<2>&);
template std::vector<EndedSmoothJoint> remove_ended_smooth_joints<3>(Specimen<3>&);
} // namespace feldspar

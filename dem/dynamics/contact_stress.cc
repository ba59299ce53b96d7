// Mean fields of the contact forces of a body in motion.

#include "dem/dynamics/dynamics.h"
#include "dem/specimen/rigid_groups.h"

#include <algorithm>
#include <cmath>

namespace feldspar
{
namespace
{
/// Calls add(force on grain 2, grain 1, grain 2) for each joint, then for each smooth joint and each contact without a
/// face. Joints come as they are stored, or by their numbers: in an order that does not depend on where they are stored.
template <int dim, class Add>
void for_each_contact_force(const Specimen<dim>& body, const Touches<dim>& touches, const Add& add,
                            const bool by_number = false)
{
  const auto add_joint = [&](const std::size_t j) {
    add(at<dim>(body.joints.force, j), body.joints.grain_1[j], body.joints.grain_2[j]);
  };
  if (by_number)
    std::ranges::for_each(body.joints.by_number(), add_joint);
  else
    for (std::size_t j = 0; j < body.joints.size(); ++j)
      add_joint(j);
  for (const auto& joint : body.smooth_joints)
    add(Vector<dim>(Eigen::Map<const Vector<dim>>(joint.force.data())), joint.grain_1, joint.grain_2);
  touches.for_each_touch([&](const Touch<dim>& touch) {
    add(Vector<dim>(Eigen::Map<const Vector<dim>>(touch.on_grains.force.data())), touch.grain_1, touch.grain_2);
  });
}

/// Calls add(σV, grain) for each grain that a wall presses: the moment of the wall's force about the centre of the grain,
/// or of its rigid group, in tension positive [N m].
template <int dim, class Add>
void for_each_wall_moment(const Specimen<dim>& body, const Walls<dim>& walls, const BodyCentres<dim>& centres,
                          const Add& add)
{
  walls.for_each_touch([&](const Wall& wall, const WallTouch<dim>& touch) {
    const Vector<dim> normal = wall_direction(body, wall, touch.grain);
    const double distance = std::abs(wall_coordinate(body, wall, touch.grain) - wall.position);
    const double force = walls.stiffness(body, body.grains.radius[touch.grain]) * touch.overlap;
    const Vector<dim> from_centre = at<dim>(body.grains.position, touch.grain) - centres.of(touch.grain);
    add(Tensor<dim>(-(force * distance * (normal * normal.transpose())) +
                    wall.side * force * normal * from_centre.transpose()),
        touch.grain);
  });
}

/// All members of a group get the sums of their group.
template <int dim>
void share_among_members(const std::vector<std::uint32_t>& group, std::vector<Tensor<dim>>& stress,
                         std::vector<double>& volume)
{
  std::vector<Tensor<dim>> stress_of(group.size(), Tensor<dim>::Zero());
  std::vector<double> volume_of(group.size(), 0.0);
  for (std::size_t i = 0; i < group.size(); ++i)
    {
      stress_of[group[i]] += stress[i];
      volume_of[group[i]] += volume[i];
    }
  for (std::size_t i = 0; i < group.size(); ++i)
    {
      stress[i] = stress_of[group[i]];
      volume[i] = volume_of[group[i]];
    }
}
} // namespace

template <int dim>
Tensor<dim> Dynamics<dim>::mean_stress() const
{
  const BodyCentres<dim> centres(body);
  Tensor<dim> sum = Tensor<dim>::Zero();
  const auto add = [&](const Vector<dim>& force, const std::uint32_t one, const std::uint32_t two) {
    sum -= force * (centres.of(two) - centres.of(one)).transpose();
  };
  for_each_contact_force(body, touches, add);
  for_each_wall_moment(body, wall_set, centres, [&](const Tensor<dim>& moment, std::size_t) { sum += moment; });
  return sum / body.volume();
}

template <int dim>
std::vector<Tensor<dim>> Dynamics<dim>::grain_stresses() const
{
  const auto& grains = body.grains;
  std::vector<Tensor<dim>> stress(grains.size(), Tensor<dim>::Zero());
  const BodyCentres<dim> centres(body);
  // f on grain 2, at the middle of the face: as far from grain 1 as `arm`.
  const auto add = [&](const Vector<dim>& force, const std::uint32_t one, const std::uint32_t two) {
    const Vector<dim> branch = at<dim>(grains.position, two) - at<dim>(grains.position, one);
    const double distance = branch.norm();
    const double arm = 0.5 * (distance + grains.radius[one] - grains.radius[two]);
    stress[one] -= force * branch.transpose() * (arm / distance);
    stress[two] -= force * branch.transpose() * (1.0 - arm / distance);
    if (body.groups_are_rigid)
      {
        stress[one] -= force * (at<dim>(grains.position, one) - centres.of(one)).transpose();
        stress[two] += force * (at<dim>(grains.position, two) - centres.of(two)).transpose();
      }
  };
  for_each_contact_force(body, touches, add, true);
  for_each_wall_moment(body, wall_set, centres,
                       [&](const Tensor<dim>& moment, const std::size_t grain) { stress[grain] += moment; });
  const double solid_share = 1.0 - body.report.porosity;
  std::vector<double> volume(grains.size());
  for (std::size_t i = 0; i < stress.size(); ++i)
    volume[i] = grain_volume<dim>(grains.radius[i], body.thickness);
  if (body.groups_are_rigid)
    share_among_members<dim>(body.groups, stress, volume);
  for (std::size_t i = 0; i < stress.size(); ++i)
    stress[i] *= solid_share / volume[i];
  if (!part.is_shared())
    return stress;
  std::vector<double> components; // of the own grains
  for (std::uint32_t i = part.grains().first; i < part.grains().end; ++i)
    components.insert(components.end(), stress[i].data(), stress[i].data() + stress[i].size());
  const std::vector<double> all = part.gathered(components);
  for (std::size_t i = 0; i < stress.size(); ++i)
    stress[i] = Eigen::Map<const Tensor<dim>>(&all[i * stress[i].size()]);
  return stress;
}

template <int dim>
Tensor<dim> Dynamics<dim>::boundary_stress() const
{
  Tensor<dim> sum = Tensor<dim>::Zero();
  const auto add = [&](const Vector<dim>& force, std::uint32_t, const std::uint32_t two) {
    if (two >= images.n_own())
      sum -= force * images.way_to(two).transpose();
  };
  for_each_contact_force(body, touches, add);
  return sum / body.volume();
}

template <int dim>
double Dynamics<dim>::force_across(const double height) const
{
  const BodyCentres<dim> centres(body);
  const auto& y = centres.all()[dim - 1];
  ExactSum sum;
  const auto add = [&](const Vector<dim>& force, const std::uint32_t one, const std::uint32_t two) {
    if (part.counts(one) && (y[one] < height) != (y[two] < height))
      sum.add(y[two] < height ? -force[dim - 1] : force[dim - 1]);
  };
  for_each_contact_force(body, touches, add);
  return part.totals({sum})[0];
}

template <int dim>
double Dynamics<dim>::mean_contact_force() const
{
  ExactSum sum;
  std::size_t n_contacts = 0;
  const auto add = [&](const std::uint32_t grain_1, const double force) {
    if (!part.counts(grain_1))
      return;
    sum.add(force);
    ++n_contacts;
  };
  for (std::size_t j = 0; j < body.joints.size(); ++j)
    add(body.joints.grain_1[j], std::sqrt(squared_norm<dim>(body.joints.force, j)));
  for (const auto& joint : body.smooth_joints)
    add(joint.grain_1, Eigen::Map<const Vector<dim>>(joint.force.data()).norm());
  touches.for_each_touch([&](const Touch<dim>& touch) {
    if (touch.touching)
      add(touch.grain_1, std::hypot(touch.normal_force, simd::magnitude(touch.shear_force)));
  });
  ExactSum n;
  n.add(double(n_contacts));
  const std::vector<double> totals = part.totals({sum, n});
  return totals[1] > 0.0 ? totals[0] / totals[1] : 0.0;
}

template Tensor<2> Dynamics<2>::mean_stress() const;
template Tensor<3> Dynamics<3>::mean_stress() const;
template std::vector<Tensor<2>> Dynamics<2>::grain_stresses() const;
template std::vector<Tensor<3>> Dynamics<3>::grain_stresses() const;
template Tensor<2> Dynamics<2>::boundary_stress() const;
template Tensor<3> Dynamics<3>::boundary_stress() const;
template double Dynamics<2>::force_across(double) const;
template double Dynamics<3>::force_across(double) const;
template double Dynamics<2>::mean_contact_force() const;
template double Dynamics<3>::mean_contact_force() const;
} // namespace feldspar

#include "dem/dynamics/time_step.h"

#include "base/parallel.h"
#include "dem/laws/face_elements.h"

#include <algorithm>
#include <variant>

namespace feldspar
{
template <int dim>
double largest_stiffness_over_inertia(const Specimen<dim>& body, const RigidGroups<dim>& groups, const GrainRange& own,
                                      const Incidence& joints_of, const Touches<dim>& touches, const Walls<dim>& walls)
{
  const auto& grains = body.grains;
  const auto& joints = body.joints;
  const Incidence& touches_of = touches.incidence();
  const Grains<dim>& bodies = groups.empty() ? grains : groups.bodies;
  const GrainRange moved = groups.empty() ? own : GrainRange{0, std::uint32_t(groups.size())};
  const std::size_t n_bodies = groups.empty() ? grains.size() : groups.size();
  Components<dim> k;
  resize<dim>(k, n_bodies);
  Components<n_rotations<dim>> k_turning;
  resize<n_rotations<dim>>(k_turning, n_bodies);
  // Adds a contact at `arm` from the centre of a grain along the normal; negative: against it.
  const auto add = [&](const std::uint32_t grain, const auto& normal, const double k_n, const double k_s,
                       const double arm, const double k_bending, const double k_twist) {
    std::uint32_t i = grain;
    if constexpr (dim == 2)
      if (!groups.empty())
        {
          // Turning a group moves the contact across its arm from the centre of the group, which does not lie along the
          // normal.
          i = groups.body_of(grain);
          const Vector<2> from_centre =
            at<2>(grains.position, grain) - at<2>(bodies.position, i) + arm * Vector<2>(normal[0], normal[1]);
          const double along = from_centre[0] * normal[0] + from_centre[1] * normal[1];
          const double across = from_centre[1] * normal[0] - from_centre[0] * normal[1];
          k_turning[0][i] += (k_n * across * across + k_s * along * along) - k_s * arm * arm;
        }
    for (int c = 0; c < dim; ++c)
      k[c][i] += k_n * normal[c] * normal[c] + k_s * (1.0 - normal[c] * normal[c]);
    for (int c = 0; c < n_rotations<dim>; ++c)
      {
        const double axial = dim == 3 ? normal[c] * normal[c] : 0.0; // discs turn about an axis across every normal
        k_turning[c][i] += (k_s * arm * arm + k_bending) * (1.0 - axial) + k_twist * axial;
      }
  };
  const auto add_touch = [&](const Touch<dim>& touch, const bool is_second, const std::uint32_t grain) {
    const double k_s = body.particle_contact.friction > 0.0 ? touch.stiffness.shear : 0.0;
    const auto a = arms(touch.frame.distance, touch.half_radius_difference);
    add(grain, touch.frame.normal, touch.stiffness.normal, k_s, is_second ? -a.two : a.one, 0.0, 0.0);
  };
  // To each grain come its joints and then its contacts by their numbers, whether it is grains or contacts that are
  // gone through.
  const bool by_touches = groups.empty() && stays_on_this_thread(own.size());
  const auto add_contacts = [&](const auto& law, const std::size_t begin, const std::size_t end) {
    for (auto i = own.first + std::uint32_t(begin); i < own.first + end; ++i)
      {
        for (auto e = joints_of.first[i]; e < joints_of.first[i + 1]; ++e)
          {
            const std::uint32_t j = joints_of.entries[e] / 2;
            const bool is_second = joints_of.entries[e] % 2;
            const FaceSprings springs = law.stiffest(joints.face(j));
            const auto a = arms(joints.rest_distance[j] + joints.opening[j], joints.half_radius_difference[j]);
            add(i, at<dim>(joints.normal, j), springs.normal, springs.shear, is_second ? -a.two : a.one,
                springs.bending, springs.twist);
          }
        if (by_touches)
          continue;
        for (auto e = touches_of.first[i]; e < touches_of.first[i + 1]; ++e)
          if (const std::uint32_t entry = touches_of.entries[e]; touches.is_touching(entry / 2))
            add_touch(touches.touch(entry / 2), entry % 2, i);
      }
  };
  if (groups.empty())
    for_each_block(own.size(), [&](std::size_t, const std::size_t begin, const std::size_t end) {
      std::visit([&](const auto& law) { add_contacts(law, begin, end); }, joints.law);
    });
  else // members of one group may be of several blocks
    std::visit([&](const auto& law) { add_contacts(law, 0, own.size()); }, joints.law);
  if (by_touches)
    for (std::size_t k = 0; k < touches.size(); ++k)
      if (touches.is_touching(k))
        {
          const Touch<dim>& touch = touches.touch(k);
          add_touch(touch, false, touch.grain_1);
          add_touch(touch, true, touches.owner_2(k));
        }
  for (const SmoothJoint<dim>& joint : body.smooth_joints)
    for (const std::uint32_t i : {joint.grain_1, joint.grain_2})
      {
        const Vector<dim> branch = Eigen::Map<const Vector<dim>>(joint.branch.data());
        const double share = share_of_grain_1(joint, branch);
        const double arm = (i == joint.grain_1 ? share : 1.0 - share) * branch.norm();
        // Turning moves the sides across the line of centres, whichever way that lies to the plane.
        const double turning =
          joint.area * arm * arm * std::max(joint.face.normal_stiffness, joint.face.shear_stiffness);
        add(i, joint.normal, joint.area * joint.face.normal_stiffness, joint.area * joint.face.shear_stiffness, 0.0,
            turning, turning);
      }
  walls.for_each_touch([&](const Wall& wall, const WallTouch<dim>& touch) {
    if (!(touch.overlap > 0.0))
      return;
    const double k_n = walls.stiffness(body, grains.radius[touch.grain]);
    const double k_s = wall.friction > 0.0 ? k_n / body.particle_contact.stiffness_ratio : 0.0;
    add(touch.grain, wall_direction(body, wall, touch.grain), k_n, k_s,
        -wall.side * (touch.zero_distance - touch.overlap), 0.0, 0.0);
  });

  double largest = 0.0;
  for (std::size_t i = moved.first; i < moved.end; ++i)
    {
      for (int c = 0; c < dim; ++c)
        largest = std::max(largest, k[c][i] / bodies.mass[i]);
      for (int c = 0; c < n_rotations<dim>; ++c)
        largest = std::max(largest, k_turning[c][i] / bodies.moment_of_inertia[i]);
    }
  return largest;
}

template <int dim>
double stiffness_over_inertia_of_touches(const Specimen<dim>& body)
{
  double largest = 0.0;
  for (std::size_t i = 0; i < body.grains.size(); ++i)
    {
      const double radius = body.grains.radius[i];
      const double k_n = touch_stiffness<dim>(body.particle_contact.modulus, radius, radius, body.thickness);
      largest = std::max(largest, 4.0 * k_n / body.grains.mass[i]);
    }
  return largest;
}

template <int dim>
double largest_stiffness_over_inertia(const Specimen<dim>& body)
{
  const auto joints_of = incidence(
    body.grains.size(), body.joints.size(),
    [&](const std::size_t j) {
      return GrainPair{body.joints.grain_1[j], body.joints.grain_2[j]};
    },
    [](const std::uint32_t grain) { return grain; });
  Touches<dim> none;
  none.number(Images<dim>(body));
  const double of_joints = largest_stiffness_over_inertia(
    body, RigidGroups<dim>(body), {0, std::uint32_t(body.grains.size())}, joints_of, none, Walls<dim>());
  return of_joints > 0.0 ? of_joints : stiffness_over_inertia_of_touches(body);
}

template double stiffness_over_inertia_of_touches<2>(const Specimen<2>&);
template double stiffness_over_inertia_of_touches<3>(const Specimen<3>&);
template double largest_stiffness_over_inertia<2>(const Specimen<2>&);
template double largest_stiffness_over_inertia<3>(const Specimen<3>&);
template double largest_stiffness_over_inertia<2>(const Specimen<2>&, const RigidGroups<2>&, const GrainRange&,
                                                  const Incidence&, const Touches<2>&, const Walls<2>&);
template double largest_stiffness_over_inertia<3>(const Specimen<3>&, const RigidGroups<3>&, const GrainRange&,
                                                  const Incidence&, const Touches<3>&, const Walls<3>&);
} // namespace feldspar

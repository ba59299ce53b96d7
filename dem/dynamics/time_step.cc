#include "dem/dynamics/time_step.h"

#include "base/parallel.h"
#include "dem/laws/face_elements.h"

#include <algorithm>
#include <variant>

namespace feldspar
{
template <int dim>
double largest_stiffness_over_inertia(const Specimen<dim>& body, const std::size_t n_own, const Incidence& joints_of,
                                      const Touches<dim>& touches, const Walls<dim>& walls)
{
  const auto& grains = body.grains;
  const auto& joints = body.joints;
  const Incidence& touches_of = touches.incidence();
  Components<dim> k;
  resize<dim>(k, n_own);
  Components<n_rotations<dim>> k_turning;
  resize<n_rotations<dim>>(k_turning, n_own);
  const auto add = [&](const std::uint32_t i, const auto& normal, const double k_n, const double k_s, const double arm,
                       const double k_bending, const double k_twist) {
    for (int c = 0; c < dim; ++c)
      k[c][i] += k_n * normal[c] * normal[c] + k_s * (1.0 - normal[c] * normal[c]);
    for (int c = 0; c < n_rotations<dim>; ++c)
      {
        const double axial = dim == 3 ? normal[c] * normal[c] : 0.0; // discs turn about an axis across every normal
        k_turning[c][i] += (k_s * arm * arm + k_bending) * (1.0 - axial) + k_twist * axial;
      }
  };
  const auto add_contacts = [&](const auto& law, const std::size_t begin, const std::size_t end) {
    for (auto i = std::uint32_t(begin); i < end; ++i)
      {
        for (auto e = joints_of.first[i]; e < joints_of.first[i + 1]; ++e)
          {
            const std::uint32_t j = joints_of.entries[e] / 2;
            const bool is_second = joints_of.entries[e] % 2;
            const FaceSprings springs = law.stiffest(joints.face(j));
            const auto a = arms(joints.rest_distance[j] + joints.opening[j], joints.half_radius_difference[j]);
            add(i, at<dim>(joints.normal, j), springs.normal, springs.shear, is_second ? a.two : a.one, springs.bending,
                springs.twist);
          }
        for (auto e = touches_of.first[i]; e < touches_of.first[i + 1]; ++e)
          {
            const Touch<dim>& touch = touches.list()[touches_of.entries[e] / 2];
            const bool is_second = touches_of.entries[e] % 2;
            if (!touch.touching)
              continue;
            const double k_s = body.particle_contact.friction > 0.0 ? touch.stiffness.shear : 0.0;
            const auto a = arms(touch.frame.distance, touch.half_radius_difference);
            add(i, touch.frame.normal, touch.stiffness.normal, k_s, is_second ? a.two : a.one, 0.0, 0.0);
          }
      }
  };
  for_each_block(n_own, [&](std::size_t, const std::size_t begin, const std::size_t end) {
    std::visit([&](const auto& law) { add_contacts(law, begin, end); }, joints.law);
  });
  walls.for_each_touch([&](const Wall& wall, const WallTouch<dim>& touch) {
    if (!(touch.overlap > 0.0))
      return;
    const double k_n = walls.stiffness(body, grains.radius[touch.grain]);
    const double k_s = wall.friction > 0.0 ? k_n / body.particle_contact.stiffness_ratio : 0.0;
    add(touch.grain, wall_direction(body, wall, touch.grain), k_n, k_s, touch.zero_distance - touch.overlap, 0.0, 0.0);
  });

  double largest = 0.0;
  for (std::size_t i = 0; i < n_own; ++i)
    {
      for (int c = 0; c < dim; ++c)
        largest = std::max(largest, k[c][i] / grains.mass[i]);
      for (int c = 0; c < n_rotations<dim>; ++c)
        largest = std::max(largest, k_turning[c][i] / grains.moment_of_inertia[i]);
    }
  if (largest == 0.0)
    for (std::size_t i = 0; i < n_own; ++i)
      {
        const double radius = grains.radius[i];
        const double k_n = touch_stiffness<dim>(body.particle_contact.modulus, radius, radius, body.thickness);
        largest = std::max(largest, 4.0 * k_n / grains.mass[i]);
      }
  return largest;
}

template double largest_stiffness_over_inertia<2>(const Specimen<2>&, std::size_t, const Incidence&, const Touches<2>&,
                                                  const Walls<2>&);
template double largest_stiffness_over_inertia<3>(const Specimen<3>&, std::size_t, const Incidence&, const Touches<3>&,
                                                  const Walls<3>&);
} // namespace feldspar

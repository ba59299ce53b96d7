#include "dem/dynamics/contact_stress.h"

#include "dem/laws/flat_joint_law.h"

#include <cmath>

namespace feldspar
{
template <int dim>
Tensor<dim> mean_stress(const Specimen<dim>& body, const Touches<dim>& touches, const Walls<dim>& walls)
{
  const auto& grains = body.grains;
  Tensor<dim> sum = Tensor<dim>::Zero();
  const auto add = [&](const Vector<dim>& force, const std::uint32_t one, const std::uint32_t two) {
    sum -= force * (at<dim>(grains.position, two) - at<dim>(grains.position, one)).transpose();
  };
  for (std::size_t j = 0; j < body.joints.size(); ++j)
    add(at<dim>(body.joints.force, j), body.joints.grain_1[j], body.joints.grain_2[j]);
  for (const auto& touch : touches.list())
    add(Eigen::Map<const Vector<dim>>(touch.force.data()), touch.grain_1, touch.grain_2);
  walls.for_each_touch([&](const Wall& wall, const WallTouch<dim>& touch) {
    const Vector<dim> normal = wall_direction(body, wall, touch.grain);
    const double distance = std::abs(wall_coordinate(body, wall, touch.grain) - wall.position);
    sum -= walls.stiffness(body, grains.radius[touch.grain]) * touch.overlap * distance * (normal * normal.transpose());
  });
  return sum / body.volume();
}

template <int dim>
std::vector<Tensor<dim>> grain_stresses(const Specimen<dim>& body, const Touches<dim>& touches, const Walls<dim>& walls)
{
  const auto& grains = body.grains;
  std::vector<Tensor<dim>> stress(grains.size(), Tensor<dim>::Zero());
  // f on grain 2, at the middle of the face: as far from grain 1 as `arm`.
  const auto add = [&](const Vector<dim>& force, const std::uint32_t one, const std::uint32_t two) {
    const Vector<dim> branch = at<dim>(grains.position, two) - at<dim>(grains.position, one);
    const double distance = branch.norm();
    const double arm = 0.5 * (distance + grains.radius[one] - grains.radius[two]);
    stress[one] -= force * branch.transpose() * (arm / distance);
    stress[two] -= force * branch.transpose() * (1.0 - arm / distance);
  };
  for (std::size_t j = 0; j < body.joints.size(); ++j)
    add(at<dim>(body.joints.force, j), body.joints.grain_1[j], body.joints.grain_2[j]);
  for (const auto& touch : touches.list())
    add(Eigen::Map<const Vector<dim>>(touch.force.data()), touch.grain_1, touch.grain_2);
  walls.for_each_touch([&](const Wall& wall, const WallTouch<dim>& touch) {
    const Vector<dim> normal = wall_direction(body, wall, touch.grain);
    const double distance = std::abs(wall_coordinate(body, wall, touch.grain) - wall.position);
    stress[touch.grain] -=
      walls.stiffness(body, grains.radius[touch.grain]) * touch.overlap * distance * (normal * normal.transpose());
  });
  const double solid_share = 1.0 - body.report.porosity;
  for (std::size_t i = 0; i < stress.size(); ++i)
    stress[i] *= solid_share / grain_volume<dim>(grains.radius[i], body.thickness);
  return stress;
}

template <int dim>
Tensor<dim> boundary_stress(const Specimen<dim>& body, const Touches<dim>& touches, const Images<dim>& images)
{
  Tensor<dim> sum = Tensor<dim>::Zero();
  const auto add = [&](const Vector<dim>& force, const std::uint32_t two) {
    if (two >= images.n_own())
      sum -= force * images.way_to(two).transpose();
  };
  for (std::size_t j = 0; j < body.joints.size(); ++j)
    add(at<dim>(body.joints.force, j), body.joints.grain_2[j]);
  for (const auto& touch : touches.list())
    add(Eigen::Map<const Vector<dim>>(touch.force.data()), touch.grain_2);
  return sum / body.volume();
}

template <int dim>
double force_across(const Specimen<dim>& body, const Touches<dim>& touches, const double height)
{
  const auto& y = body.grains.position[dim - 1];
  double sum = 0.0;
  const auto add = [&](const double force, const std::uint32_t one, const std::uint32_t two) {
    if ((y[one] < height) != (y[two] < height))
      sum += y[two] < height ? -force : force;
  };
  for (std::size_t j = 0; j < body.joints.size(); ++j)
    add(body.joints.force[dim - 1][j], body.joints.grain_1[j], body.joints.grain_2[j]);
  for (const auto& touch : touches.list())
    add(touch.force[dim - 1], touch.grain_1, touch.grain_2);
  return sum;
}

template <int dim>
double mean_contact_force(const Specimen<dim>& body, const Touches<dim>& touches)
{
  double sum = 0.0;
  std::size_t n_contacts = body.joints.size();
  for (std::size_t j = 0; j < body.joints.size(); ++j)
    sum += std::sqrt(squared_norm<dim>(body.joints.force, j));
  for (const auto& touch : touches.list())
    if (touch.touching)
      {
        sum += std::hypot(touch.normal_force, flat_joint::magnitude(touch.shear_force));
        ++n_contacts;
      }
  return n_contacts > 0 ? sum / double(n_contacts) : 0.0;
}

template Tensor<2> mean_stress<2>(const Specimen<2>&, const Touches<2>&, const Walls<2>&);
template Tensor<3> mean_stress<3>(const Specimen<3>&, const Touches<3>&, const Walls<3>&);
template std::vector<Tensor<2>> grain_stresses<2>(const Specimen<2>&, const Touches<2>&, const Walls<2>&);
template std::vector<Tensor<3>> grain_stresses<3>(const Specimen<3>&, const Touches<3>&, const Walls<3>&);
template Tensor<2> boundary_stress<2>(const Specimen<2>&, const Touches<2>&, const Images<2>&);
template Tensor<3> boundary_stress<3>(const Specimen<3>&, const Touches<3>&, const Images<3>&);
template double force_across<2>(const Specimen<2>&, const Touches<2>&, double);
template double force_across<3>(const Specimen<3>&, const Touches<3>&, double);
template double mean_contact_force<2>(const Specimen<2>&, const Touches<2>&);
template double mean_contact_force<3>(const Specimen<3>&, const Touches<3>&);
} // namespace feldspar

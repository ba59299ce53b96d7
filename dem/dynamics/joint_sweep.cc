#include "dem/dynamics/joint_sweep.h"

#include "dem/dynamics/joint_sweep_of_law.h"

#include <variant>

namespace feldspar
{
template <int dim>
std::vector<Break> sweep_joints(Joints<dim>& joints, const Grains<dim>& grains, const double dt)
{
  return std::visit([&](const auto& law) { return sweep_joints(law, joints, grains, dt); }, joints.law);
}

template <int dim>
bool has_face(const Joints<dim>& joints, const std::size_t j)
{
  return std::visit([&](const auto& law) { return has_face(law, joints, j); }, joints.law);
}

template <int dim>
double joint_energy(const Joints<dim>& joints, const std::size_t j)
{
  return std::visit([&](const auto& law) { return joint_energy(law, joints, j); }, joints.law);
}

template std::vector<Break> sweep_joints<2>(Joints<2>&, const Grains<2>&, double);
template std::vector<Break> sweep_joints<3>(Joints<3>&, const Grains<3>&, double);
template bool has_face<2>(const Joints<2>&, std::size_t);
template bool has_face<3>(const Joints<3>&, std::size_t);
template double joint_energy<2>(const Joints<2>&, std::size_t);
template double joint_energy<3>(const Joints<3>&, std::size_t);
} // namespace feldspar

#include "dem/dynamics/sweeps/joint_sweep.h"

#include "dem/dynamics/sweeps/joint_state_of_law.h"
#include "dem/dynamics/sweeps/joint_sweep_of_law.h"

#include <utility>
#include <variant>

namespace feldspar
{
template <int dim>
SweepMemory<dim>::SweepMemory(const Joints<dim>& joints)
{
  weakest.resize(n_weakest, joints.size());
  for (std::size_t j = 0; j < joints.size(); ++j)
    {
      double least_tension = std::numeric_limits<double>::infinity();
      double least_cohesion = least_tension;
      for (unsigned int i = 0; i < joints.n_segments; ++i)
        {
          const std::size_t segment = joints.segment(i, j);
          least_tension = std::min(least_tension, joints.tensile_strength[segment]);
          least_cohesion = std::min(least_cohesion, joints.cohesion[segment]);
        }
      const auto [whole, rests] = std::visit(
        [&](const auto& law) { return std::pair(is_whole(law, joints, j), stands_open_without_bonds(law, joints, j)); },
        joints.law);
      *weakest.at(tensile_strength, j) = whole ? least_tension : -joint_sweep::infinity;
      *weakest.at(cohesion, j) = whole ? least_cohesion : rests ? stands_open : in_pieces;
    }
}

template <int dim>
std::vector<Break> sweep_joints(Joints<dim>& joints, const Grains<dim>& grains, const double dt,
                                SweepMemory<dim>& memory, const BehindSweep& behind)
{
  return std::visit([&](const auto& law) { return sweep_joints(law, joints, grains, dt, memory, behind); }, joints.law);
}

template <int dim>
std::array<double, dim - 1> shear_stress(const Joints<dim>& joints, const unsigned int segment, const std::size_t joint)
{
  return std::visit([&](const auto& law) { return segment_state<dim>(law, joints, segment, joint).shear_stress; },
                    joints.law);
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

template <int dim>
double dissipated_by_bonds(const Joints<dim>& joints, const std::size_t j)
{
  return std::visit([&](const auto& law) { return dissipated_by_bonds(law, joints, j); }, joints.law);
}

template struct SweepMemory<2>;
template struct SweepMemory<3>;
template std::vector<Break> sweep_joints<2>(Joints<2>&, const Grains<2>&, double, SweepMemory<2>&, const BehindSweep&);
template std::vector<Break> sweep_joints<3>(Joints<3>&, const Grains<3>&, double, SweepMemory<3>&, const BehindSweep&);
template std::array<double, 1> shear_stress<2>(const Joints<2>&, unsigned int, std::size_t);
template std::array<double, 2> shear_stress<3>(const Joints<3>&, unsigned int, std::size_t);
template bool has_face<2>(const Joints<2>&, std::size_t);
template bool has_face<3>(const Joints<3>&, std::size_t);
template double joint_energy<2>(const Joints<2>&, std::size_t);
template double joint_energy<3>(const Joints<3>&, std::size_t);
template double dissipated_by_bonds<2>(const Joints<2>&, std::size_t);
template double dissipated_by_bonds<3>(const Joints<3>&, std::size_t);
} // namespace feldspar

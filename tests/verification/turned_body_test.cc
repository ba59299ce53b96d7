// Bodies whose grains are moved by hand, in very many steps: what they store must be that of where they stand.

#include "dem/dynamics/sweeps/joint_sweep.h"
#include "tests/unit/small_specimen.h"

#include <gtest/gtest.h>

#include <Eigen/Geometry>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <type_traits>

namespace feldspar
{
namespace
{
constexpr double stronger = 1e3; ///< bonds of a body that is to stay whole

template <int dim>
Specimen<dim> body(const double bond_strength_factor = 1.0)
{
  if constexpr (dim == 2)
    return small_specimen(1, bond_strength_factor);
  else
    return small_cylinder(1, bond_strength_factor);
}

template <int dim>
void set_positions(Grains<dim>& grains, const decltype(Grains<dim>::position)& start, const Tensor<dim>& map)
{
  for (std::size_t i = 0; i < grains.size(); ++i)
    set<dim>(grains.position, i, Vector<dim>(map * at<dim>(start, i)));
}

/// About k, or about an axis that is askew to all others.
template <int dim>
Tensor<dim> turned_by(const double angle)
{
  if constexpr (dim == 2)
    return Eigen::Rotation2Dd(angle).toRotationMatrix();
  else
    return Eigen::AngleAxisd(angle, Vector<3>(0.6, 0.64, 0.48)).toRotationMatrix();
}

template <int dim>
double largest_stress(const Joints<dim>& joints)
{
  double largest = 0.0;
  for (std::size_t j = 0; j < joints.size(); ++j)
    {
      Vector<dim> force = at<dim>(joints.force, j);
      largest = std::max(largest, force.norm() / joints.face_area(j));
      for (unsigned int i = 0; i < joints.n_segments; ++i)
        for (const double component : shear_stress(joints, i, j))
          largest = std::max(largest, std::abs(component));
    }
  return largest;
}

template <int dim>
double strain_energy(const Joints<dim>& joints)
{
  double sum = 0.0;
  for (std::size_t j = 0; j < joints.size(); ++j)
    sum += joint_energy(joints, j);
  return sum;
}

template <typename>
using MovedBody = testing::Test;
TYPED_TEST_SUITE(MovedBody, Dimensions);

// A turn is no strain. Stress is what round-off leaves: of positions 1e-18 m, which stiffnesses of some 1e14 Pa/m make 1e-4 Pa a
// step. Half broken: every second joint has no bond any more, and every fourth has half of its bonds.
TYPED_TEST(MovedBody, IsFreeOfStressAfterAQuarterTurnInAHundredThousandSteps)
{
  constexpr int dim = TypeParam::value;
  constexpr int n_steps = 100000;
  for (const bool half_broken : {false, true})
    {
      SCOPED_TRACE(half_broken ? "half broken" : "whole");
      auto specimen = body<dim>();
      auto& joints = specimen.joints;
      auto& grains = specimen.grains;
      for (std::size_t j = 0; half_broken && j < joints.size(); ++j)
        for (unsigned int i = 0; i < joints.n_segments; ++i)
          if (j % 2 == 0 || (j % 4 == 1 && i % 2 == 0))
            joints.bonded[joints.segment(i, j)] = 0.0;
      const auto start = grains.position;
      const double step = 0.5 * std::numbers::pi / n_steps;
      const Vector<3> axis = dim == 2 ? Vector<3>(1.0, 0.0, 0.0) : Vector<3>(0.6, 0.64, 0.48);
      for (std::size_t c = 0; c < n_rotations<dim>; ++c)
        std::ranges::fill(grains.spin[c], step * axis[Eigen::Index(c)]);
      SweepMemory<dim> memory(joints);
      for (int k = 1; k <= n_steps; ++k)
        {
          set_positions<dim>(grains, start, turned_by<dim>(k * step));
          ASSERT_TRUE(sweep_joints(joints, grains, 1.0, memory).empty()) << k;
        }
      EXPECT_LT(largest_stress(joints), 1e-9 * FlatJointParameters().bond_tensile_strength);
    }
}

// Strained by a thousandth and sheared, its grains turning as they please; then all the way back in as many steps.
TYPED_TEST(MovedBody, GivesBackItsEnergyWhileItsBondsHold)
{
  constexpr int dim = TypeParam::value;
  constexpr int n_steps = 1000;
  auto specimen = body<dim>(stronger);
  auto& joints = specimen.joints;
  auto& grains = specimen.grains;
  Tensor<dim> strain = Tensor<dim>::Constant(4e-4);
  strain(0, 0) = -1e-3;
  strain(1, 0) = -2e-4;
  const auto start = grains.position;
  SweepMemory<dim> memory(joints);
  double largest = 0.0;
  for (int k = 1; k <= 2 * n_steps; ++k)
    {
      const bool is_forward = k <= n_steps;
      const double share = double(is_forward ? k : 2 * n_steps - k) / n_steps;
      set_positions<dim>(grains, start, Tensor<dim>(Tensor<dim>::Identity() + share * strain));
      for (std::size_t c = 0; c < n_rotations<dim>; ++c)
        for (std::size_t i = 0; i < grains.size(); ++i)
          grains.spin[c][i] = (is_forward ? 1e-3 : -1e-3) * std::sin(double(i) + double(c)) / n_steps;
      ASSERT_TRUE(sweep_joints(joints, grains, 1.0, memory).empty()) << k;
      largest = std::max(largest, strain_energy(joints));
    }
  EXPECT_GT(largest, 0.0);
  EXPECT_LT(std::abs(strain_energy(joints)), 1e-12 * largest);
}
} // namespace
} // namespace feldspar

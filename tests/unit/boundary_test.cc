// The elasticity of a representative volume under the weakest and the strictest hold on its boundary.

#include "coupling/rve/stiffness_bounds.h"

#include "dem/genesis/coring.h"
#include "tests/unit/small_rve.h"

#include <Eigen/Eigenvalues>
#include <gtest/gtest.h>

#include <vector>

namespace feldspar
{
namespace
{
template <typename Case>
class Bounds : public testing::Test
{
};
TYPED_TEST_SUITE(Bounds, Dimensions);

template <int dim>
double least_eigenvalue(const Stiffness<dim>& matrix)
{
  return Eigen::SelfAdjointEigenSolver<Stiffness<dim>>(matrix).eigenvalues().minCoeff();
}

// Motions that an affine boundary admits are admitted by a periodic one, and these by a minimal kinematic one; the energy
// of an intact network is least over what is admitted, at every strain. Stiffnesses are therefore ordered as matrices.
TYPED_TEST(Bounds, MinimalKinematicIsBelowPeriodicBelowAffine)
{
  constexpr int dim = TypeParam::value;
  for (const std::uint64_t seed : {1, 2, 3})
    {
      const Network<dim> network(periodic_specimen<dim>(seed));
      const Stiffness<dim>& periodic = network.intact_stiffness();
      const auto bounds = stiffness_bounds(network);
      const double size = periodic.norm();
      // Well apart: a boundary that was periodic by mistake would be equal, to 1e-9.
      EXPECT_GT(least_eigenvalue<dim>(periodic - bounds.minimal_kinematic), 1e-4 * size) << seed;
      EXPECT_GT(least_eigenvalue<dim>(bounds.affine - periodic), 1e-5 * size) << seed;
      EXPECT_GT(least_eigenvalue<dim>(bounds.minimal_kinematic), 0.0) << seed;
    }
}

// A turned cell has turned bounds: the areas of its sides turn with it.
TEST(Bounds, TurnWithTheCell)
{
  const auto specimen = periodic_specimen<2>(1);
  Tensor<2> quarter;
  quarter << 0.0, -1.0, 1.0, 0.0;
  const auto upright = stiffness_bounds(Network<2>(specimen));
  const auto lying = stiffness_bounds(Network<2>(specimen, quarter));
  for (const auto& [one, other] :
       {std::pair(upright.minimal_kinematic, lying.minimal_kinematic), std::pair(upright.affine, lying.affine)})
    {
      EXPECT_NEAR(one(0, 0), other(1, 1), 1e-6 * one(0, 0));
      EXPECT_NEAR(one(0, 1), other(1, 0), 1e-6 * one(0, 0));
      EXPECT_NEAR(one(2, 2), other(2, 2), 1e-6 * one(0, 0));
    }
}

// The same rock in one, two and four cells each way: the periodic stiffness stays, and the layer in which a boundary
// changes it becomes a half and a quarter of the body. The bracket therefore narrows as 1/L; layers that meet in the
// smallest body and corners leave a tenth or two.
TEST(Bounds, NarrowAsOneOverTheSize)
{
  const auto cell = periodic_specimen<2>(1);
  std::vector<double> below, above;
  for (const unsigned int n : {1u, 2u, 4u})
    {
      const Network<2> network(repeated<2>(cell, {n, n}));
      const auto bounds = stiffness_bounds(network);
      const Stiffness<2>& periodic = network.intact_stiffness();
      below.push_back((periodic - bounds.minimal_kinematic).trace() / periodic.trace());
      above.push_back((bounds.affine - periodic).trace() / periodic.trace());
    }
  for (const auto& share : {below, above})
    {
      EXPECT_NEAR(share[1] / share[0], 0.5, 0.15);
      EXPECT_NEAR(share[2] / share[1], 0.5, 0.10);
    }
}
} // namespace
} // namespace feldspar

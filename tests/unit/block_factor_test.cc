#include "coupling/network/block_factor.h"

#include "base/random.h"
#include "tests/unit/small_rve.h"

#include <Eigen/Cholesky>
#include <gtest/gtest.h>

#include <cmath>
#include <memory>
#include <vector>

namespace feldspar
{
namespace
{
template <typename>
using BlockFactors = testing::Test;
TYPED_TEST_SUITE(BlockFactors, Dimensions);

/// Links whose gradients are any numbers, so that no block of the matrix is symmetric by itself. Some join a grain to an
/// image of itself, and some a pair that is joined already, as in a small cell.
template <int dim>
std::vector<Link<dim>> any_links(const std::uint32_t n_grains)
{
  Random random(1, RandomStream::dealing);
  const auto any_grain = [&] { return std::uint32_t(random.uniform() * n_grains); };
  std::vector<Link<dim>> links(3 * n_grains);
  for (std::size_t k = 0; k < links.size(); ++k)
    {
      Link<dim>& link = links[k];
      link.grain_1 = any_grain();
      link.grain_2 = k % 20 == 0 ? link.grain_1 : any_grain();
      if (k % 20 == 1)
        {
          link.grain_1 = links[k / 2].grain_2;
          link.grain_2 = links[k / 2].grain_1;
        }
      for (double& entry : link.by_grains.reshaped())
        entry = random.uniform(-1.0, 1.0);
    }
  return links;
}

/// Each grain of a square is linked with the next ones on both sides: a factor with many empty blocks.
template <int dim>
std::vector<Link<dim>> links_of_a_lattice(const std::uint32_t n_grains)
{
  const auto n_across = std::uint32_t(std::sqrt(n_grains));
  Random random(3, RandomStream::dealing);
  std::vector<Link<dim>> links;
  for (std::uint32_t i = 0; i < n_grains; ++i)
    for (const std::uint32_t next : {i + 1, i + n_across})
      if (next < n_grains)
        {
          Link<dim>& link = links.emplace_back();
          link.grain_1 = i;
          link.grain_2 = next;
          for (double& entry : link.by_grains.reshaped())
            entry = random.uniform(-1.0, 1.0);
        }
  return links;
}

/// Returns whether a link has a stiffness: all have one but each seventh.
bool bears(const std::uint32_t link) { return link % 7 != 3; }

/// Compares with the same matrix, added up in full and factorised by Eigen.
template <int dim>
void expect_to_solve_as_a_full_matrix_does(const std::vector<Link<dim>>& links, const std::uint32_t n_grains)
{
  constexpr int n = n_motions<dim>;
  BlockFactor<dim> factor(std::make_shared<const StiffnessPattern>(links, n_grains, bears));
  Eigen::MatrixXd full = Eigen::MatrixXd::Zero(n * n_grains, n * n_grains);
  for (std::uint32_t k = 0; k < links.size(); ++k)
    {
      if (!bears(k))
        continue;
      JointStiffness<dim> stiffness = JointStiffness<dim>::Identity();
      stiffness(0, 0) = 0.5 + double(k % 3);
      factor.add(links[k], stiffness);
      const Eigen::Matrix<double, 2 * n, 2 * n> of_link =
        links[k].by_grains.transpose() * stiffness * links[k].by_grains;
      const std::uint32_t grains[] = {links[k].grain_1, links[k].grain_2};
      for (int a = 0; a < 2; ++a)
        for (int b = 0; b < 2; ++b)
          full.block<n, n>(n * grains[a], n * grains[b]) += of_link.template block<n, n>(n * a, n * b);
    }
  for (std::uint32_t i = 0; i < n_grains; ++i)
    for (int c = 0; c < n; ++c)
      {
        EXPECT_NEAR(factor.diagonal(i, c), full(n * i + c, n * i + c), 1e-14 * full(n * i + c, n * i + c));
        factor.set_diagonal(i, c, factor.diagonal(i, c) + 1.0);
        full(n * i + c, n * i + c) += 1.0;
      }
  factor.factorise();

  const Eigen::VectorXd b = Eigen::VectorXd::LinSpaced(n * n_grains, -1.0, 2.0);
  const Eigen::VectorXd x = factor.solve(b);
  const Eigen::VectorXd expected = full.ldlt().solve(b);
  // The least eigenvalue is 1 at least and the largest some 50: round-off grows by no more. In space that of L is 2^-24.
  constexpr double condition = 50.0;
  EXPECT_LT((x - expected).norm(), (dim == 2 ? 1e-13 : condition * std::ldexp(1.0, -24)) * expected.norm());
  EXPECT_GT(factor.cost_of_factor(), 1.0);
  // However L is rounded, conjugate gradients are given a symmetric inverse.
  const Eigen::VectorXd other = Eigen::VectorXd::LinSpaced(n * n_grains, 1.0, 0.0);
  EXPECT_NEAR(other.dot(x), b.dot(factor.solve(other)), 1e-13 * other.norm() * x.norm());

  // Several right sides at once: each as by itself, and zeros behind them.
  UnitUnknowns<dim> together = UnitUnknowns<dim>::Zero(n * n_grains, UnitUnknowns<dim>::ColsAtCompileTime);
  Random random(2, RandomStream::dealing);
  for (int k = 0; k < n_voigt<dim>; ++k)
    for (Eigen::Index i = 0; i < together.rows(); ++i)
      together(i, k) = random.uniform(-1.0, 1.0);
  const UnitUnknowns<dim> solved = factor.solve(together);
  for (int k = 0; k < n_voigt<dim>; ++k)
    EXPECT_LT((solved.col(k) - factor.solve(Eigen::VectorXd(together.col(k)))).norm(), 1e-13 * solved.col(k).norm());
  EXPECT_TRUE(solved.rightCols(solved.cols() - n_voigt<dim>).isZero(0.0));
}

TYPED_TEST(BlockFactors, SolveAsAFullMatrixDoes)
{
  constexpr int dim = TypeParam::value;
  expect_to_solve_as_a_full_matrix_does(any_links<dim>(40), 40);
  // With two bodies apart from it: a chain, and grains that nothing holds.
  auto links = links_of_a_lattice<dim>(144);
  for (std::uint32_t i = 144; i + 5 < 160; ++i)
    {
      links.push_back(links[i]);
      links.back().grain_1 = i;
      links.back().grain_2 = i + 1;
    }
  expect_to_solve_as_a_full_matrix_does(links, 160);
}

TEST(StiffnessPattern, JoinsColumnsOfTheSameRowsIntoSupernodes)
{
  // All columns have the rows of the one before if each grain is linked with each.
  constexpr std::uint32_t n_grains = 20;
  std::vector<Link<2>> links;
  for (std::uint32_t i = 0; i < n_grains; ++i)
    for (std::uint32_t j = 0; j < i; ++j)
      {
        links.emplace_back();
        links.back().grain_1 = i;
        links.back().grain_2 = j;
      }
  const StiffnessPattern dense(links, n_grains, [](std::uint32_t) { return true; });
  EXPECT_EQ(dense.n_blocks(), n_grains * (n_grains - 1) / 2);
  ASSERT_EQ(dense.n_supernodes(), 3u);
  EXPECT_EQ(dense.first_column(1), StiffnessPattern::most_columns);
  EXPECT_EQ(dense.first_column(2), 2 * StiffnessPattern::most_columns);
  EXPECT_EQ(dense.first_column(3), n_grains);
  // Each grain stands alone if no link has a stiffness.
  const StiffnessPattern empty(links, n_grains, [](std::uint32_t) { return false; });
  EXPECT_EQ(empty.n_blocks(), 0u);
  EXPECT_EQ(empty.n_supernodes(), n_grains);
}

// Conjugate gradients ask for it. A cell may shift as a whole, by forces that round-off leaves without balance.
TYPED_TEST(BlockFactors, OfAPeriodicCellGiveASymmetricInverse)
{
  constexpr int dim = TypeParam::value;
  const Network<dim> network(periodic_specimen<dim>());
  const auto& factorised = network.factorised_intact();
  std::array<bool, n_voigt<dim>> is_free{};
  is_free.fill(true);
  Random random(4, RandomStream::dealing);
  const auto any_forces = [&] { // without couples, by which grains turn much farther
    Unknowns forces = Unknowns::Zero(network.n_unknowns());
    for (std::size_t i = 0; i < network.n_grains(); ++i)
      for (int c = 0; c < dim; ++c)
        forces[n_motions<dim> * Eigen::Index(i) + c] = random.uniform(-1.0, 1.0);
    return forces;
  };
  const Unknowns one = any_forces(), other = any_forces();
  const Unknowns by_one = factorised.solve(one, is_free), by_other = factorised.solve(other, is_free);
  // Round-off in the sums of forces is multiplied by up to 1e9, over what is lent to the shift of the whole.
  EXPECT_NEAR(other.dot(by_one), one.dot(by_other), 1e-6 * std::abs(other.dot(by_one)));
  // No forces shift the cell.
  Vector<dim> shift = Vector<dim>::Zero();
  double size = 0.0;
  for (std::size_t i = 0; i < network.n_grains(); ++i)
    {
      const auto motion = by_one.template segment<dim>(n_motions<dim> * Eigen::Index(i));
      shift += motion;
      size += motion.norm();
    }
  EXPECT_LT(shift.norm(), 1e-12 * size);
}
} // namespace
} // namespace feldspar

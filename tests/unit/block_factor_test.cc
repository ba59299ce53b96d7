#include "coupling/network/block_factor.h"

#include "base/random.h"
#include "tests/unit/small_rve.h"

#include <Eigen/Cholesky>
#include <gtest/gtest.h>

#include <vector>

namespace feldspar
{
namespace
{
template <typename Case>
class BlockFactors : public testing::Test
{
};
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

/// Against the same matrix, added up in full and factorised by Eigen.
TYPED_TEST(BlockFactors, SolveAsAFullMatrixDoes)
{
  constexpr int dim = TypeParam::value;
  constexpr int n = n_motions<dim>;
  constexpr std::uint32_t n_grains = 40;
  const auto links = any_links<dim>(n_grains);
  const StiffnessPattern pattern(links, n_grains);
  BlockFactor<dim> factor(pattern);
  Eigen::MatrixXd full = Eigen::MatrixXd::Zero(n * n_grains, n * n_grains);
  for (std::size_t k = 0; k < links.size(); ++k)
    {
      JointStiffness<dim> stiffness = JointStiffness<dim>::Identity();
      stiffness(0, 0) = 0.5 + double(k % 3);
      factor.add(links[k], k, stiffness);
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
  // The least eigenvalue is 1 at least and the largest some 50: round-off grows by no more.
  EXPECT_LT((x - expected).norm(), 1e-13 * expected.norm());
  EXPECT_GT(factor.cost_of_factor(), 1.0);

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
} // namespace
} // namespace feldspar

#pragma once

#include "base/simd_transpose.h"
#include "coupling/network/stiffness_pattern.h"

#include <array>
#include <cstddef>
#include <type_traits>
#include <vector>

namespace feldspar
{
#ifdef __AVX512F__
using ColumnOfSix = simd::Eight;
#else
/// Six numbers and two zeros, on a processor whose vectors have four: GCC moves its vectors of eight there in pieces of eight
/// and sixteen bytes, by which a solution took twice as long.
struct ColumnOfSix
{
  std::array<simd::Four, 2> halves{};

  double& operator[](const int k) { return reinterpret_cast<double*>(halves.data())[k]; }
  double operator[](const int k) const { return reinterpret_cast<const double*>(halves.data())[k]; }

  ColumnOfSix& operator+=(const ColumnOfSix& other)
  {
    halves[0] += other.halves[0];
    halves[1] += other.halves[1];
    return *this;
  }
  ColumnOfSix& operator-=(const ColumnOfSix& other)
  {
    halves[0] -= other.halves[0];
    halves[1] -= other.halves[1];
    return *this;
  }
  ColumnOfSix& operator*=(const ColumnOfSix& other)
  {
    halves[0] *= other.halves[0];
    halves[1] *= other.halves[1];
    return *this;
  }
  ColumnOfSix& operator*=(const double factor)
  {
    halves[0] *= factor;
    halves[1] *= factor;
    return *this;
  }

  friend ColumnOfSix operator+(ColumnOfSix one, const ColumnOfSix& other) { return one += other; }
  friend ColumnOfSix operator*(ColumnOfSix one, const ColumnOfSix& other) { return one *= other; }
  friend ColumnOfSix operator*(ColumnOfSix one, const double factor) { return one *= factor; }
};
#endif

/// A symmetric, positive definite matrix of a network's grains, then its factor L D Lᵀ, in blocks of the motions of two grains. A column of a
/// block is one vector of the processor, with zeros below the motions of a grain: most of the time of a damaged
/// representative volume goes into solving with this factor. Eigen's factor, number by number, takes two to four times as
/// long (benchmarks/README.md); that of CHOLMOD is no faster but for hundreds of spheres, and its bits depend on the library
/// of linear algebra that a machine has. Here sums are in one order, and every processor gives the same bits.
template <int dim>
class BlockFactor
{
public:
  using Column = std::conditional_t<dim == 2, simd::Four, ColumnOfSix>;

  /// All zero.
  explicit BlockFactor(const StiffnessPattern& pattern);

  /// Adds Gᵀ D G of a link to the matrix.
  void add(const Link<dim>& link, std::size_t number, const JointStiffness<dim>& stiffness);
  /// The entry of a motion of a grain on the diagonal of the matrix.
  double diagonal(std::size_t grain, int motion) const;
  void set_diagonal(std::size_t grain, int motion, double value);

  /// From the matrix to its factor; once.
  void factorise();

  /// x of A x = b; [n_motions * n_grains], grain by grain.
  Eigen::VectorXd solve(const Eigen::VectorXd& b) const;
  /// Of several at once: of six, three and a half times as fast as one by one. Sums are in another order.
  UnitUnknowns<dim> solve(const UnitUnknowns<dim>& b) const;

  std::size_t bytes() const
  {
    return sizeof(Column) * (diagonals.size() + blocks.size() + pivots.size() + inverse_pivots.size());
  }

  /// Operations of factorise() over those of solve(), roughly.
  double cost_of_factor() const;

private:
  static constexpr int n = n_motions<dim>;

  void factorise_diagonal(std::size_t k);

  const StiffnessPattern& pattern;
  std::vector<Column> diagonals; ///< n for each grain, in their places
  std::vector<Column> blocks;    ///< n for each block
  std::vector<Column> pivots;    ///< D
  std::vector<Column> inverse_pivots;
};
} // namespace feldspar

#pragma once

#include "coupling/network/block_columns.h"
#include "coupling/network/stiffness_pattern.h"

#include <cstddef>
#include <memory>
#include <vector>

namespace feldspar
{
/// A symmetric, positive definite matrix of a network's grains, then its factor L D Lᵀ, in blocks of the motions of two grains. A
/// column of a block is one vector of the processor, with zeros below the motions of a grain: most of the time of a damaged
/// representative volume goes into solving with this factor. Eigen's factor, number by number, takes longer
/// (benchmarks/README.md), and the bits of CHOLMOD's depend on the library of linear algebra that a machine has. Here sums are
/// in one order, and every processor that rounds a product and a sum once (all with AVX2) gives the same bits.
///
/// In space L is made in double precision and kept in single (KeptBlockColumn). Solutions are then those of another
/// matrix, as symmetric and as definite, whose L differs by 6e-8: enough for conjugate gradients.
template <int dim>
class BlockFactor
{
public:
  using Column = BlockColumn<dim>;

  /// All zero.
  explicit BlockFactor(std::shared_ptr<const StiffnessPattern> pattern);

  /// Adds Gᵀ D G of a link to the matrix.
  void add(const Link<dim>& link, const JointStiffness<dim>& stiffness);
  /// The entry of a motion of a grain on the diagonal of the matrix.
  double diagonal(std::size_t grain, int motion) const;
  void set_diagonal(std::size_t grain, int motion, double value);

  /// Turns the matrix into its factor; once.
  void factorise();

  /// x of A x = b, nearly; [n_motions * n_grains], grain by grain.
  Eigen::VectorXd solve(const Eigen::VectorXd& b) const;
  /// Solves for several right-hand sides at once; for six, three and a half times as fast as one by one. Sums are in
  /// another order.
  UnitUnknowns<dim> solve(const UnitUnknowns<dim>& b) const;

  std::size_t bytes() const
  {
    return sizeof(Column) * (diagonals.size() + inverse_pivots.size()) + sizeof(KeptColumn) * kept_blocks.size() +
           pattern->bytes();
  }

  /// Operations of factorise() over those of solve(), roughly.
  double cost_of_factor() const;

private:
  using KeptColumn = KeptBlockColumn<dim>;
  static constexpr int n = n_motions<dim>;

  void subtract(std::uint32_t begin, std::uint32_t end, std::uint32_t block, std::uint32_t column,
                const std::vector<std::uint32_t>& place_of_row);
  void factorise_column(std::size_t k);

  std::shared_ptr<const StiffnessPattern> pattern;
  std::vector<Column> diagonals; ///< n for each grain, in their places
  std::vector<Column> blocks;    ///< n for each block; empty once they are factorised
  std::vector<Column> pivots;    ///< D, until then
  std::vector<Column> inverse_pivots;
  std::vector<KeptColumn> kept_blocks; ///< of L, below its diagonal
};
} // namespace feldspar

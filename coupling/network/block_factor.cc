#include "coupling/network/block_factor.h"

#include <algorithm>
#include <array>
#include <utility>

namespace feldspar
{
namespace
{
/// Adds a block of a matrix, or its transpose, to columns.
template <typename Column, typename Block>
void add_block(const Block& block, Column* const columns)
{
  for (int c = 0; c < block.cols(); ++c)
    for (int r = 0; r < block.rows(); ++r)
      columns[c][r] += block(r, c);
}
} // namespace

template <int dim>
BlockFactor<dim>::BlockFactor(std::shared_ptr<const StiffnessPattern> of)
  : pattern(std::move(of))
  , diagonals(n * pattern->n_grains(), Column{})
  , blocks(n * pattern->n_blocks(), Column{})
{
}

template <int dim>
void BlockFactor<dim>::add(const Link<dim>& link, const JointStiffness<dim>& stiffness)
{
  const Eigen::Matrix<double, 2 * n, 2 * n> of_link = link.by_grains.transpose() * (stiffness * link.by_grains);
  const std::uint32_t first = pattern->place(link.grain_1), second = pattern->place(link.grain_2);
  add_block(of_link.template topLeftCorner<n, n>(), &diagonals[n * first]);
  add_block(of_link.template bottomRightCorner<n, n>(), &diagonals[n * second]);
  const auto coupling = of_link.template topRightCorner<n, n>(); // rows of the first grain
  if (first == second)                                           // a grain and its image
    {
      add_block(coupling, &diagonals[n * first]);
      add_block(coupling.transpose(), &diagonals[n * first]);
    }
  else if (first < second)
    add_block(coupling.transpose(), &blocks[n * pattern->block_at(second, first)]);
  else
    add_block(coupling, &blocks[n * pattern->block_at(first, second)]);
}

template <int dim>
double BlockFactor<dim>::diagonal(const std::size_t grain, const int motion) const
{
  return diagonals[n * pattern->place(grain) + std::size_t(motion)][motion];
}

template <int dim>
void BlockFactor<dim>::set_diagonal(const std::size_t grain, const int motion, const double value)
{
  diagonals[n * pattern->place(grain) + std::size_t(motion)][motion] = value;
}

/// Subtracts from a column, from its diagonal on, the products L D Lᵀ of the blocks of the columns from `begin` to `end`, of one
/// supernode, with those in its row, of which `block` is the one in column `begin`. place_of_row: of each row, among the blocks
/// of the first column of the supernode of `column`.
template <int dim>
void BlockFactor<dim>::subtract(const std::uint32_t begin, const std::uint32_t end, const std::uint32_t block,
                                const std::uint32_t column, const std::vector<std::uint32_t>& place_of_row)
{
  std::array<const Column*, StiffnessPattern::most_columns> from;
  std::array<std::array<std::array<double, n>, n>, StiffnessPattern::most_columns>
    weights; // L D of the blocks in the row
  const std::size_t n_columns = end - begin;
  for (std::size_t k = 0; k < n_columns; ++k)
    {
      // Each column has one block less above this row than the one before.
      const std::size_t in_row = block + pattern->first_block(begin + k) - pattern->first_block(begin) - k;
      from[k] = &blocks[n * in_row];
      for (int j = 0; j < n; ++j)
        {
          const Column weight = from[k][j] * pivots[begin + k][j];
          for (int c = 0; c < n; ++c)
            weights[k][std::size_t(j)][std::size_t(c)] = weight[c];
        }
    }
  const std::uint32_t first_of_supernode = pattern->first_column(pattern->supernode_of(column));
  const std::size_t shift = pattern->first_block(column) - (column - first_of_supernode);
  const std::size_t n_rows = pattern->first_block(begin + 1) - block;
  for (std::size_t r = 0; r < n_rows; ++r)
    {
      Column* const to = r == 0 ? &diagonals[n * column] : &blocks[n * (shift + place_of_row[pattern->row(block + r)])];
      std::array<Column, n> sums;
      std::copy_n(to, n, sums.begin());
      for (std::size_t k = 0; k < n_columns; ++k)
        for (std::size_t j = 0; j < n; ++j)
          {
            const Column of = from[k][n * r + j];
            for (std::size_t c = 0; c < n; ++c)
              sums[c] = minus_product(sums[c], of, weights[k][j][c]);
          }
      std::copy_n(sums.begin(), n, to);
    }
}

/// L and D of a column from which the columns before it have been subtracted. The block on the diagonal keeps the part
/// of L below its own diagonal of ones.
template <int dim>
void BlockFactor<dim>::factorise_column(const std::size_t k)
{
  Column* const of_diagonal = &diagonals[n * k];
  pivots.push_back(Column{});
  inverse_pivots.push_back(Column{});
  for (int c = 0; c < n; ++c)
    {
      const Column column = of_diagonal[c];
      pivots.back()[c] = column[c];
      inverse_pivots.back()[c] = 1.0 / column[c];
      of_diagonal[c] = column * inverse_pivots.back()[c];
      for (int r = 0; r <= c; ++r)
        of_diagonal[c][r] = 0.0;
      for (int later = c + 1; later < n; ++later)
        of_diagonal[later] -= of_diagonal[c] * column[later];
    }
  for (std::uint32_t b = pattern->first_block(k); b < pattern->first_block(k + 1); ++b)
    {
      Column* const block = &blocks[n * b];
      for (int c = 0; c < n; ++c)
        for (int before = 0; before < c; ++before)
          block[c] -= block[before] * of_diagonal[before][c];
      for (int c = 0; c < n; ++c)
        block[c] = block[c] * inverse_pivots.back()[c];
    }
}

/// Supernode by supernode, each less what those before it give (left-looking: Ng and Peyton 1993). One that is done waits at the
/// next one that has a row of it.
template <int dim>
void BlockFactor<dim>::factorise()
{
  struct Source
  {
    std::uint32_t supernode;
    std::uint32_t block; ///< of its first column, in the first row that is still to be taken
  };
  std::vector<std::vector<Source>> sources(pattern->n_supernodes());
  const auto hand_on = [&](const Source& source) {
    if (source.block < pattern->first_block(pattern->first_column(source.supernode) + 1))
      sources[pattern->supernode_of(pattern->row(source.block))].push_back(source);
  };
  pivots.reserve(pattern->n_grains());
  inverse_pivots.reserve(pattern->n_grains());
  std::vector<std::uint32_t> place_of_row(pattern->n_grains());
  for (std::uint32_t supernode = 0; supernode < pattern->n_supernodes(); ++supernode)
    {
      const std::uint32_t begin = pattern->first_column(supernode), end = pattern->first_column(supernode + 1);
      const std::uint32_t first_block = pattern->first_block(begin), last_block = pattern->first_block(begin + 1);
      for (std::uint32_t b = first_block; b < last_block; ++b)
        place_of_row[pattern->row(b)] = b - first_block;
      for (Source source : std::exchange(sources[supernode], {}))
        {
          const std::uint32_t from = pattern->first_column(source.supernode);
          for (; source.block < pattern->first_block(from + 1) && pattern->row(source.block) < end; ++source.block)
            subtract(from, pattern->first_column(source.supernode + 1), source.block, pattern->row(source.block),
                     place_of_row);
          hand_on(source);
        }
      for (std::uint32_t k = begin; k < end; ++k)
        {
          if (k > begin)
            subtract(begin, k, first_block + (k - begin - 1), k, place_of_row);
          factorise_column(k);
        }
      hand_on({supernode, first_block + (end - begin - 1)});
    }
  kept_blocks.reserve(blocks.size());
  for (const Column& column : blocks)
    kept_blocks.push_back(kept<dim>(column));
  blocks = std::vector<Column>(); // {} would keep their memory
  pivots = std::vector<Column>();
}

template <int dim>
Eigen::VectorXd BlockFactor<dim>::solve(const Eigen::VectorXd& b) const
{
  const std::size_t n_grains = pattern->n_grains();
  std::vector<Column> x(n_grains, Column{});
  for (std::size_t i = 0; i < n_grains; ++i)
    for (int c = 0; c < n; ++c)
      x[pattern->place(i)][c] = b[n * Eigen::Index(i) + c];

  for (std::size_t k = 0; k < n_grains; ++k) // L
    {
      Column own = x[k];
      for (int c = 0; c + 1 < n; ++c)
        own -= diagonals[n * k + std::size_t(c)] * own[c];
      for (std::uint32_t block = pattern->first_block(k); block < pattern->first_block(k + 1); ++block)
        {
          Column& other = x[pattern->row(block)];
          for (int c = 0; c < n; ++c)
            other = minus_product(other, widened(kept_blocks[n * block + std::size_t(c)]), own[c]);
        }
      x[k] = own * inverse_pivots[k];
    }
  for (std::size_t k = n_grains; k-- > 0;) // Lᵀ
    {
      std::array<Column, n> sums{};
      for (std::uint32_t block = pattern->first_block(k); block < pattern->first_block(k + 1); ++block)
        {
          const Column other = x[pattern->row(block)];
          for (int c = 0; c < n; ++c)
            sums[std::size_t(c)] =
              minus_product(sums[std::size_t(c)], widened(kept_blocks[n * block + std::size_t(c)]), other);
        }
      for (int c = n - 1; c >= 0; --c)
        x[k][c] += sum_of(minus_product(sums[std::size_t(c)], diagonals[n * k + std::size_t(c)], x[k]));
    }

  Eigen::VectorXd result(b.size());
  for (std::size_t i = 0; i < n_grains; ++i)
    for (int c = 0; c < n; ++c)
      result[n * Eigen::Index(i) + c] = x[pattern->place(i)][c];
  return result;
}

template <int dim>
UnitUnknowns<dim> BlockFactor<dim>::solve(const UnitUnknowns<dim>& b) const
{
  // A column holds one motion of a grain by every right side.
  constexpr int n_columns = UnitUnknowns<dim>::ColsAtCompileTime;
  using Motions = std::array<Column, n>;
  const auto widened_block = [&](const std::uint32_t block) {
    Motions columns;
    for (std::size_t c = 0; c < n; ++c)
      columns[c] = widened(kept_blocks[n * block + c]);
    return columns;
  };
  const std::size_t n_grains = pattern->n_grains();
  std::vector<Motions> x(n_grains);
  for (std::size_t i = 0; i < n_grains; ++i)
    for (int c = 0; c < n; ++c)
      for (int k = 0; k < n_columns; ++k)
        x[pattern->place(i)][std::size_t(c)][k] = b(n * Eigen::Index(i) + c, k);

  for (std::size_t k = 0; k < n_grains; ++k) // L
    {
      Motions own = x[k];
      for (int c = 0; c + 1 < n; ++c)
        for (int r = c + 1; r < n; ++r)
          own[std::size_t(r)] -= own[std::size_t(c)] * diagonals[n * k + std::size_t(c)][r];
      for (std::uint32_t block = pattern->first_block(k); block < pattern->first_block(k + 1); ++block)
        {
          Motions& other = x[pattern->row(block)];
          const Motions of_block = widened_block(block);
          for (int r = 0; r < n; ++r)
            {
              Column sum = other[std::size_t(r)];
              for (int c = 0; c < n; ++c)
                sum = minus_product(sum, own[std::size_t(c)], of_block[std::size_t(c)][r]);
              other[std::size_t(r)] = sum;
            }
        }
      for (int r = 0; r < n; ++r)
        x[k][std::size_t(r)] = own[std::size_t(r)] * inverse_pivots[k][r];
    }
  for (std::size_t k = n_grains; k-- > 0;) // Lᵀ
    {
      Motions own = x[k];
      for (std::uint32_t block = pattern->first_block(k); block < pattern->first_block(k + 1); ++block)
        {
          const Motions& other = x[pattern->row(block)];
          const Motions of_block = widened_block(block);
          for (int c = 0; c < n; ++c)
            {
              Column sum = own[std::size_t(c)];
              for (int r = 0; r < n; ++r)
                sum = minus_product(sum, other[std::size_t(r)], of_block[std::size_t(c)][r]);
              own[std::size_t(c)] = sum;
            }
        }
      for (int c = n - 1; c >= 0; --c)
        for (int r = c + 1; r < n; ++r)
          own[std::size_t(c)] -= own[std::size_t(r)] * diagonals[n * k + std::size_t(c)][r];
      x[k] = own;
    }

  UnitUnknowns<dim> result(b.rows(), b.cols());
  for (std::size_t i = 0; i < n_grains; ++i)
    for (int c = 0; c < n; ++c)
      for (int k = 0; k < n_columns; ++k)
        result(n * Eigen::Index(i) + c, k) = x[pattern->place(i)][std::size_t(c)][k];
  return result;
}

template <int dim>
double BlockFactor<dim>::cost_of_factor() const
{
  // Every block below the diagonal is multiplied by those at and below it in its column, and used twice in a solution.
  double products = 0.0;
  for (std::size_t k = 0; k < pattern->n_grains(); ++k)
    {
      const double n_below = pattern->first_block(k + 1) - pattern->first_block(k);
      products += 0.5 * n_below * (n_below + 1.0);
    }
  return n * products / (2.0 * double(pattern->n_grains() + pattern->n_blocks()));
}

template class BlockFactor<2>;
template class BlockFactor<3>;
} // namespace feldspar

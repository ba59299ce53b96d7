#include "coupling/network/block_factor.h"

#include <array>

namespace feldspar
{
namespace
{
double sum_of(const simd::Four& v) { return (v[0] + v[1]) + (v[2] + v[3]); }

double sum_of(const ColumnOfSix& column)
{
#ifdef __AVX512F__
  return sum_of(simd::low_half(column) + simd::high_half(column));
#else
  return sum_of(column.halves[0] + column.halves[1]);
#endif
}

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
BlockFactor<dim>::BlockFactor(const StiffnessPattern& of)
  : pattern(of)
  , diagonals(n * of.n_grains(), Column{})
  , blocks(n * of.n_blocks(), Column{})
{
}

template <int dim>
void BlockFactor<dim>::add(const Link<dim>& link, const std::size_t number, const JointStiffness<dim>& stiffness)
{
  const Eigen::Matrix<double, 2 * n, 2 * n> of_link = link.by_grains.transpose() * (stiffness * link.by_grains);
  const auto& place = pattern.place_of_link(number);
  add_block(of_link.template topLeftCorner<n, n>(), &diagonals[n * place.first]);
  add_block(of_link.template bottomRightCorner<n, n>(), &diagonals[n * place.second]);
  const auto coupling = of_link.template topRightCorner<n, n>(); // rows of the first grain
  if (place.block == StiffnessPattern::none)
    {
      add_block(coupling, &diagonals[n * place.first]);
      add_block(coupling.transpose(), &diagonals[n * place.first]);
    }
  else if (place.is_transposed)
    add_block(coupling.transpose(), &blocks[n * place.block]);
  else
    add_block(coupling, &blocks[n * place.block]);
}

template <int dim>
double BlockFactor<dim>::diagonal(const std::size_t grain, const int motion) const
{
  return diagonals[n * pattern.place(grain) + std::size_t(motion)][motion];
}

template <int dim>
void BlockFactor<dim>::set_diagonal(const std::size_t grain, const int motion, const double value)
{
  diagonals[n * pattern.place(grain) + std::size_t(motion)][motion] = value;
}

/// L and D of a block on the diagonal; of L what stands below its own diagonal of ones.
template <int dim>
void BlockFactor<dim>::factorise_diagonal(const std::size_t k)
{
  Column* const of = &diagonals[n * k];
  pivots.push_back(Column{});
  inverse_pivots.push_back(Column{});
  for (int c = 0; c < n; ++c)
    {
      const Column column = of[c];
      pivots.back()[c] = column[c];
      inverse_pivots.back()[c] = 1.0 / column[c];
      of[c] = column * inverse_pivots.back()[c];
      for (int r = 0; r <= c; ++r)
        of[c][r] = 0.0;
      for (int later = c + 1; later < n; ++later)
        of[later] -= of[c] * column[later];
    }
}

/// Column by column, each less what the columns before it give (left-looking).
template <int dim>
void BlockFactor<dim>::factorise()
{
  std::vector<std::uint32_t> block_in_row(pattern.n_grains(), 0); // of the column at hand
  for (std::size_t k = 0; k < pattern.n_grains(); ++k)
    {
      const std::uint32_t begin = pattern.first_block(k), end = pattern.first_block(k + 1);
      for (std::uint32_t b = begin; b < end; ++b)
        block_in_row[pattern.row(b)] = b;
      for (const auto& [column, first] : pattern.entries_of_row(k))
        {
          std::array<std::array<double, n>, n> weights; // L D of the block in this row
          for (int j = 0; j < n; ++j)
            {
              const Column weight = blocks[n * first + std::size_t(j)] * pivots[column][j];
              for (int c = 0; c < n; ++c)
                weights[std::size_t(j)][std::size_t(c)] = weight[c];
            }
          const auto subtract_from = [&](Column* const to, const Column* const from) {
            for (int j = 0; j < n; ++j)
              for (int c = 0; c < n; ++c)
                to[c] -= from[j] * weights[std::size_t(j)][std::size_t(c)];
          };
          subtract_from(&diagonals[n * k], &blocks[n * first]);
          for (std::uint32_t b = first + 1; b < pattern.first_block(column + 1); ++b)
            subtract_from(&blocks[n * block_in_row[pattern.row(b)]], &blocks[n * b]);
        }
      factorise_diagonal(k);
      const Column* const of_diagonal = &diagonals[n * k];
      for (std::uint32_t b = begin; b < end; ++b)
        {
          Column* const block = &blocks[n * b];
          for (int c = 0; c < n; ++c)
            for (int before = 0; before < c; ++before)
              block[c] -= block[before] * of_diagonal[before][c];
          for (int c = 0; c < n; ++c)
            block[c] *= inverse_pivots[k][c];
        }
    }
}

template <int dim>
Eigen::VectorXd BlockFactor<dim>::solve(const Eigen::VectorXd& b) const
{
  const std::size_t n_grains = pattern.n_grains();
  std::vector<Column> x(n_grains, Column{});
  for (std::size_t i = 0; i < n_grains; ++i)
    for (int c = 0; c < n; ++c)
      x[pattern.place(i)][c] = b[n * Eigen::Index(i) + c];

  for (std::size_t k = 0; k < n_grains; ++k) // L
    {
      Column own = x[k];
      for (int c = 0; c + 1 < n; ++c)
        own -= diagonals[n * k + std::size_t(c)] * own[c];
      for (std::uint32_t block = pattern.first_block(k); block < pattern.first_block(k + 1); ++block)
        {
          Column& other = x[pattern.row(block)];
          for (int c = 0; c < n; ++c)
            other -= blocks[n * block + std::size_t(c)] * own[c];
        }
      x[k] = own * inverse_pivots[k];
    }
  for (std::size_t k = n_grains; k-- > 0;) // Lᵀ
    {
      std::array<Column, n> sums{};
      for (std::uint32_t block = pattern.first_block(k); block < pattern.first_block(k + 1); ++block)
        {
          const Column other = x[pattern.row(block)];
          for (int c = 0; c < n; ++c)
            sums[std::size_t(c)] += blocks[n * block + std::size_t(c)] * other;
        }
      for (int c = n - 1; c >= 0; --c)
        x[k][c] -= sum_of(sums[std::size_t(c)] + diagonals[n * k + std::size_t(c)] * x[k]);
    }

  Eigen::VectorXd result(b.size());
  for (std::size_t i = 0; i < n_grains; ++i)
    for (int c = 0; c < n; ++c)
      result[n * Eigen::Index(i) + c] = x[pattern.place(i)][c];
  return result;
}

template <int dim>
UnitUnknowns<dim> BlockFactor<dim>::solve(const UnitUnknowns<dim>& b) const
{
  // A column holds one motion of a grain by every right side.
  constexpr int n_columns = UnitUnknowns<dim>::ColsAtCompileTime;
  using Motions = std::array<Column, n>;
  const std::size_t n_grains = pattern.n_grains();
  std::vector<Motions> x(n_grains);
  for (std::size_t i = 0; i < n_grains; ++i)
    for (int c = 0; c < n; ++c)
      for (int k = 0; k < n_columns; ++k)
        x[pattern.place(i)][std::size_t(c)][k] = b(n * Eigen::Index(i) + c, k);

  for (std::size_t k = 0; k < n_grains; ++k) // L
    {
      Motions own = x[k];
      for (int c = 0; c + 1 < n; ++c)
        for (int r = c + 1; r < n; ++r)
          own[std::size_t(r)] -= own[std::size_t(c)] * diagonals[n * k + std::size_t(c)][r];
      for (std::uint32_t block = pattern.first_block(k); block < pattern.first_block(k + 1); ++block)
        {
          Motions& other = x[pattern.row(block)];
          for (int r = 0; r < n; ++r)
            {
              Column sum = other[std::size_t(r)];
              for (int c = 0; c < n; ++c)
                sum -= own[std::size_t(c)] * blocks[n * block + std::size_t(c)][r];
              other[std::size_t(r)] = sum;
            }
        }
      for (int r = 0; r < n; ++r)
        x[k][std::size_t(r)] = own[std::size_t(r)] * inverse_pivots[k][r];
    }
  for (std::size_t k = n_grains; k-- > 0;) // Lᵀ
    {
      Motions own = x[k];
      for (std::uint32_t block = pattern.first_block(k); block < pattern.first_block(k + 1); ++block)
        {
          const Motions& other = x[pattern.row(block)];
          for (int c = 0; c < n; ++c)
            {
              Column sum = own[std::size_t(c)];
              for (int r = 0; r < n; ++r)
                sum -= other[std::size_t(r)] * blocks[n * block + std::size_t(c)][r];
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
        result(n * Eigen::Index(i) + c, k) = x[pattern.place(i)][std::size_t(c)][k];
  return result;
}

template <int dim>
double BlockFactor<dim>::cost_of_factor() const
{
  // Every block below the diagonal is multiplied by those at and below it in its column, and used twice in a solution.
  double products = 0.0;
  for (std::size_t k = 0; k < pattern.n_grains(); ++k)
    {
      const double n_below = pattern.first_block(k + 1) - pattern.first_block(k);
      products += 0.5 * n_below * (n_below + 1.0);
    }
  return n * products / (2.0 * double(pattern.n_grains() + pattern.n_blocks()));
}

template class BlockFactor<2>;
template class BlockFactor<3>;
} // namespace feldspar

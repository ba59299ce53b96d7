#pragma once

#include "coupling/network/link.h"

#include <cstdint>
#include <functional>
#include <vector>

namespace feldspar
{
/// Places of the stiffnesses of links in the matrix of a network's grains, and of the entries of its factor: a block
/// for each pair of grains, below the diagonal, column by column. The grains are ordered for little fill (approximate
/// minimum degree: Amestoy, Davis and Duff 1996).
class StiffnessPattern
{
public:
  /// Pattern of the links that have a stiffness. A factor of 600 spheres that also holds their pairs
  /// without a face has half as many blocks again, and takes twice the operations.
  template <int dim>
  StiffnessPattern(const std::vector<Link<dim>>& links, std::size_t n_grains,
                   const std::function<bool(std::uint32_t link)>& has_stiffness);

  std::size_t n_grains() const { return places.size(); }
  std::size_t n_blocks() const { return rows.size(); }
  /// Place of a grain among rows and columns.
  std::uint32_t place(const std::size_t grain) const { return places[grain]; }
  /// Blocks of a column: from first_block(column) up to that of the next, in rows that ascend.
  std::uint32_t first_block(const std::size_t column) const { return first_blocks[column]; }
  std::uint32_t row(const std::size_t block) const { return rows[block]; }
  std::uint32_t block_at(std::uint32_t row, std::uint32_t column) const;

  std::size_t bytes() const
  {
    return sizeof(std::uint32_t) *
           (places.size() + first_blocks.size() + rows.size() + first_columns.size() + supernodes.size());
  }

  /// A supernode is a run of columns, each of which has the rows of the column before it except the first one, which is its own.
  /// Later columns take the products of all its columns in one go; it has few enough of them to stay in the cache meanwhile.
  std::size_t n_supernodes() const { return first_columns.size() - 1; }
  /// Columns of a supernode: from first_column(supernode) up to that of the next.
  std::uint32_t first_column(const std::size_t supernode) const { return first_columns[supernode]; }
  std::uint32_t supernode_of(const std::size_t column) const { return supernodes[column]; }
  static constexpr std::size_t most_columns = 8;

private:
  void find_fill(std::vector<std::vector<std::uint32_t>> columns);
  void find_supernodes();

  std::vector<std::uint32_t> places;
  std::vector<std::uint32_t> first_blocks;  ///< [n_grains + 1]
  std::vector<std::uint32_t> rows;          ///< [n_blocks]
  std::vector<std::uint32_t> first_columns; ///< [n_supernodes + 1]
  std::vector<std::uint32_t> supernodes;    ///< of each column
};
} // namespace feldspar

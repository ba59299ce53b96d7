#pragma once

#include "coupling/network/link.h"

#include <cstdint>
#include <vector>

namespace feldspar
{
/// Where the stiffness of each link goes in the matrix of a network's grains, and where its factor has entries: a block for
/// each pair of grains, below the diagonal, column by column. The grains are ordered for little fill (approximate minimum
/// degree: Amestoy, Davis and Duff 1996). One pattern serves all factors of a network.
class StiffnessPattern
{
public:
  template <int dim>
  StiffnessPattern(const std::vector<Link<dim>>& links, std::size_t n_grains);

  /// A block below the diagonal, in its row.
  struct Entry
  {
    std::uint32_t column, block;
  };
  /// The blocks of a link. `block` couples both grains, the first in its rows unless it is transposed; none where both
  /// ends are one grain and its image.
  struct Place
  {
    std::uint32_t first, second;
    std::uint32_t block;
    bool is_transposed;
  };
  static constexpr std::uint32_t none = std::uint32_t(-1);

  std::size_t n_grains() const { return places.size(); }
  std::size_t n_blocks() const { return rows.size(); }
  /// Place of a grain among rows and columns.
  std::uint32_t place(const std::size_t grain) const { return places[grain]; }
  /// Blocks of a column: from first_block(column) up to that of the next, in rows that ascend.
  std::uint32_t first_block(const std::size_t column) const { return first_blocks[column]; }
  std::uint32_t row(const std::size_t block) const { return rows[block]; }
  /// Blocks of a row, in columns that ascend.
  const std::vector<Entry>& entries_of_row(const std::size_t row) const { return of_row[row]; }
  const Place& place_of_link(const std::size_t link) const { return of_link[link]; }

private:
  void find_fill(std::vector<std::vector<std::uint32_t>> columns);
  std::uint32_t block_at(std::uint32_t row, std::uint32_t column) const;

  std::vector<std::uint32_t> places;
  std::vector<std::uint32_t> first_blocks; ///< [n_grains + 1]
  std::vector<std::uint32_t> rows;         ///< [n_blocks]
  std::vector<std::vector<Entry>> of_row;
  std::vector<Place> of_link;
};
} // namespace feldspar

#include "fem/mesh/partition.h"

#include <gtest/gtest.h>

namespace feldspar::fem
{
namespace
{
using Cuts = std::vector<std::size_t>;

TEST(Partition, EqualCellsAreSharedEvenly)
{
  EXPECT_EQ(partition_cuts(partition_weights(std::vector<double>(8, 2.5), 4), 4), (Cuts{0, 2, 4, 6, 8}));
  EXPECT_EQ(partition_cuts(partition_weights(std::vector<double>(8, 0.0), 2), 2), (Cuts{0, 4, 8})); // nothing measured
}

TEST(Partition, ExpensiveCellsAreSpread)
{
  // 6 of 1 s and 6 of 3 s are 24 s: 8 s a rank, which the first reaches with its eighth cell.
  std::vector<double> seconds(6, 1.0);
  seconds.insert(seconds.end(), 6, 3.0);
  const auto cuts = partition_cuts(partition_weights(seconds, 3), 3);
  EXPECT_EQ(cuts, (Cuts{0, 7, 10, 12}));
  EXPECT_DOUBLE_EQ(longest_share(seconds, cuts), 9.0);
  EXPECT_DOUBLE_EQ(longest_share(seconds, {0, 4, 8, 12}), 12.0);
}

TEST(Partition, OneExpensiveCellLeavesNoRankWithoutAny)
{
  // The share of a rank is 34 s; by weight alone the first cell would have taken those of two ranks.
  const std::vector<double> seconds{100.0, 1.0, 1.0, 1.0, 1.0};
  EXPECT_EQ(partition_cuts(partition_weights(seconds, 3), 3), (Cuts{0, 1, 3, 5}));
  // The same at the other end, where rounding once gave the last cell to the rank before.
  for (std::size_t n_ranks = 2; n_ranks <= 8; ++n_ranks)
    for (std::size_t last = 0; last < 8; ++last)
      {
        std::vector<double> all(8, 0.0);
        all[last] = all[7] = 100.0;
        const Cuts cuts = partition_cuts(partition_weights(all, n_ranks), n_ranks);
        for (std::size_t rank = 0; rank < n_ranks; ++rank)
          EXPECT_LT(cuts[rank], cuts[rank + 1]) << n_ranks << " ranks, cell " << last;
      }
  // Number of ranks equal to the number of cells.
  EXPECT_EQ(partition_cuts(partition_weights(seconds, 5), 5), (Cuts{0, 1, 2, 3, 4, 5}));
}
} // namespace
} // namespace feldspar::fem

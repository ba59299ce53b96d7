#include "fem/mesh/partition.h"

#include "base/mapped.h"

#include <algorithm>
#include <cstdint>
#include <numeric>

namespace feldspar::fem
{
namespace
{
/// Weights none of which is above `largest_share` of the share of a rank.
std::vector<unsigned int> weights_below(const double largest_share, const std::vector<double>& seconds,
                                        const std::size_t n_ranks)
{
  // Every cell is work, however short its time.
  constexpr double least_share_of_mean = 1e-3;
  const auto n = double(seconds.size());
  const double mean = std::accumulate(seconds.begin(), seconds.end(), 0.0) / n;
  auto weights =
    mapped<double>(seconds, [&](const double time) { return mean > 0.0 ? time / mean + least_share_of_mean : 1.0; });

  // Each cut of a weight lowers the share of a rank, so that more may have to be cut off.
  double sum = 0.0;
  for (int round = 0; round < 50; ++round)
    {
      sum = std::accumulate(weights.begin(), weights.end(), 0.0);
      for (double& weight : weights)
        weight = std::min(weight, largest_share * sum / double(n_ranks));
    }
  constexpr double whole = 1 << 30;
  return mapped<unsigned int>(
    weights, [&](const double weight) { return std::max(1u, static_cast<unsigned int>(weight / sum * whole)); });
}

bool leaves_a_rank_without_cell(const std::vector<unsigned int>& weights, const std::size_t n_ranks)
{
  const auto cuts = partition_cuts(weights, n_ranks);
  return std::ranges::adjacent_find(cuts) != cuts.end();
}
} // namespace

std::vector<unsigned int> partition_weights(const std::vector<double>& seconds, const std::size_t n_ranks)
{
  // Rounding may lift the weight of the last cell above the share: the rank before then takes it, and the last has none.
  for (const double largest_share : {1.0, 0.99})
    if (auto weights = weights_below(largest_share, seconds, n_ranks); !leaves_a_rank_without_cell(weights, n_ranks))
      return weights;
  return std::vector<unsigned int>(seconds.size(), 1);
}

std::vector<std::size_t> partition_cuts(const std::vector<unsigned int>& weights, const std::size_t n_ranks)
{
  // p4est_partition_given: the piece of a rank ends with the cell that reaches its share of the sum.
  const std::uint64_t sum = std::accumulate(weights.begin(), weights.end(), std::uint64_t(0));
  std::vector<std::size_t> cuts{0};
  std::uint64_t before = 0;
  std::size_t cell = 0;
  for (std::size_t rank = 1; rank <= n_ranks; ++rank)
    {
      const auto share = std::uint64_t(double(sum) * double(rank) / double(n_ranks));
      while (cell < weights.size() && before < share)
        before += weights[cell++];
      cuts.push_back(rank == n_ranks ? weights.size() : cell);
    }
  return cuts;
}

double longest_share(const std::vector<double>& seconds, const std::vector<std::size_t>& cuts)
{
  double longest = 0.0;
  for (std::size_t rank = 0; rank + 1 < cuts.size(); ++rank)
    longest = std::max(longest, std::accumulate(seconds.begin() + std::ptrdiff_t(cuts[rank]),
                                                seconds.begin() + std::ptrdiff_t(cuts[rank + 1]), 0.0));
  return longest;
}
} // namespace feldspar::fem

#pragma once

#include <cstddef>
#include <vector>

/// Partition of cells that lie along a curve among ranks, a piece of the curve for each. Arithmetic only.
namespace feldspar::fem
{
/// Weights that p4est is to share evenly: whole numbers in proportion to the time of each cell, but none above the
/// share of a rank. Every rank then gets a cell, and one expensive cell does not spoil the shares of the others. There
/// are at least as many cells as ranks; times [s] are not negative.
std::vector<unsigned int> partition_weights(const std::vector<double>& seconds, std::size_t n_ranks);

/// Positions at which p4est cuts the curve: rank r gets the cells from entry r to before entry r + 1.
std::vector<std::size_t> partition_cuts(const std::vector<unsigned int>& weights, std::size_t n_ranks);

/// The time of the rank that takes longest [s].
double longest_share(const std::vector<double>& seconds, const std::vector<std::size_t>& cuts);
} // namespace feldspar::fem

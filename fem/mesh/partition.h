#pragma once

#include <cstddef>
#include <vector>

/// How cells that lie along a curve are shared by ranks, each a piece of it. Arithmetic only.
namespace feldspar::fem
{
/// What p4est is to share evenly: whole numbers in proportion to the time each cell takes, but none above the share of a
/// rank, so that every rank gets a cell and one expensive cell does not spoil the shares of the others. At least as many
/// cells as ranks; times [s] not negative.
std::vector<unsigned int> partition_weights(const std::vector<double>& seconds, std::size_t n_ranks);

/// Where p4est cuts the curve: rank r gets the cells from entry r to before entry r + 1.
std::vector<std::size_t> partition_cuts(const std::vector<unsigned int>& weights, std::size_t n_ranks);

/// The time of the rank that takes longest [s].
double longest_share(const std::vector<double>& seconds, const std::vector<std::size_t>& cuts);
} // namespace feldspar::fem

#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <vector>

namespace feldspar::calibration
{
/// Draws from a density known up to a factor, by the random walk of Metropolis and Hastings of OpenTURNS: n points of one
/// chain, [n][dimension], after a quarter as many that are thrown away.
/// covariance: of a normal distribution near the density's, [dimension][dimension]; a step is 2.38/√dimension of it
/// (Roberts, Gelman and Gilks 1997). Outside of the bounds the density is zero.
std::vector<std::vector<double>> metropolis(const std::function<double(const std::vector<double>&)>& log_density,
                                            const std::vector<double>& lower, const std::vector<double>& upper,
                                            const std::vector<double>& start,
                                            const std::vector<std::vector<double>>& covariance, std::size_t n,
                                            std::uint64_t seed);
} // namespace feldspar::calibration

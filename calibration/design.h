#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <vector>

/// Designs and sensitivities, by OpenTURNS.
namespace feldspar::calibration
{
/// Point of the unit cube, a coordinate each.
using UnitPoint = std::vector<double>;

/// The first n points of the Sobol sequence under a random shift (Cranley and Patterson 1976); [n][dimension].
std::vector<UnitPoint> sobol_points(std::size_t n, std::size_t dimension, std::uint64_t seed);

/// Shares of the variance of a function over the unit cube.
struct SobolIndices
{
  std::vector<double> first_order; ///< by a coordinate alone
  std::vector<double> total;       ///< by it and all its interactions
};

/// Sobol indices by the estimator of Martinez (2011) with n points for each matrix, (dimension + 2) n values in all.
SobolIndices sobol_indices(const std::function<double(const UnitPoint&)>& f, std::size_t dimension, std::size_t n,
                           std::uint64_t seed);
} // namespace feldspar::calibration

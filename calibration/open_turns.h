#pragma once

#include <Eigen/Core>

#include <cstddef>
#include <cstdint>
#include <functional>
#include <memory>
#include <vector>

/// Designs, sensitivities, surrogates and samples, by OpenTURNS, whose long headers stay in one source.
namespace feldspar::calibration
{
/// Point of the unit cube, a coordinate each.
using UnitPoint = std::vector<double>;
using FunctionOfPoint = std::function<double(const std::vector<double>&)>;

/// The first n points of the Sobol sequence under a random shift (Cranley and Patterson 1976); [n][dimension].
std::vector<UnitPoint> sobol_points(std::size_t n, std::size_t dimension, std::uint64_t seed);

/// Shares of the variance of a function over the unit cube.
struct SobolIndices
{
  std::vector<double> first_order; ///< by a coordinate alone
  std::vector<double> total;       ///< by it and all its interactions
};

/// Sobol indices by the estimator of Martinez (2011) with n points for each matrix, (dimension + 2) n values in all.
SobolIndices sobol_indices(const FunctionOfPoint& f, std::size_t dimension, std::size_t n, std::uint64_t seed);

/// A smooth function of a point of the unit cube, out of values that scatter: Kriging with a linear trend and a Matérn
/// 5/2 covariance with a length for each coordinate. Copies share it.
class Surrogate
{
public:
  /// `noise`: variance of each value about the function; [n] as the values. At least dimension + 3 points.
  Surrogate(const std::vector<UnitPoint>& points, const std::vector<double>& values, const std::vector<double>& noise);

  double mean(const UnitPoint& point) const;
  /// Standard deviation of the function itself, without the scatter of a value.
  double deviation(const UnitPoint& point) const;

private:
  struct Kriging;
  std::shared_ptr<const Kriging> kriging;
};

/// Draws from a density known up to a factor, by the random walk of Metropolis and Hastings: n points of one chain,
/// [n][dimension], after a quarter as many that are thrown away.
/// covariance: of a normal distribution near the density's, [dimension × dimension]; a step is 2.38/√dimension of it
/// (Roberts, Gelman and Gilks 1997). Outside of the bounds the density is zero.
std::vector<std::vector<double>> metropolis(const FunctionOfPoint& log_density, const std::vector<double>& lower,
                                            const std::vector<double>& upper, const std::vector<double>& start,
                                            const Eigen::MatrixXd& covariance, std::size_t n, std::uint64_t seed);
} // namespace feldspar::calibration

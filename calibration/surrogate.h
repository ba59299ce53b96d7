#pragma once

#include "calibration/design.h"

#include <memory>

namespace feldspar::calibration
{
/// A smooth function of a point of the unit cube, out of values that scatter: Kriging with a linear trend and a Matérn
/// 5/2 covariance with a length for each coordinate, by OpenTURNS. Copies share it.
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
} // namespace feldspar::calibration

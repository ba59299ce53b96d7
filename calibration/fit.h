#pragma once

#include "calibration/response_model.h"

#include <vector>

namespace feldspar::calibration
{
/// The parameters that a fit may change.
struct FitFreedom
{
  bool modulus;      ///< the scale of stiffness
  bool strength;     ///< the scale of strength
  UnitPoint centre;  ///< of the unknowns' region
  double half_width; ///< of the same, in the unit cube
};

struct Fit
{
  Place place;
  double misfit;                  ///< sum of squared deviations over the tolerance
  std::vector<double> deviations; ///< of the targets, relative: prediction over target less 1
};

/// The place whose predictions are nearest to the targets, each over its tolerance and the model's error: the ratios by
/// Ceres from several starts, and for each set of them the best scales, which are known. Where targets leave unknowns open,
/// those nearest to the middle of their bounds: a weight of a hundredth of a tolerance sees to that.
Fit best_fit(const ResponseModel& model, const std::vector<Target>& targets, double tolerance,
             const FitFreedom& freedom, const Place& start);
} // namespace feldspar::calibration

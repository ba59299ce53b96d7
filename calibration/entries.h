#pragma once

#include "base/entries.h"
#include "calibration/parameters.h"

#include <vector>

namespace feldspar
{
/// The entries of section Calibration, but for the bounds and the targets, which are lists (app/input/input_entries.h).
inline std::vector<Entry<CalibrationParameters>> calibration_entries()
{
  using P = CalibrationParameters;
  return {
    entry::choice(
      "Youngs modulus", &P::youngs_modulus,
      {{"tangent", ElasticFigure::tangent}, {"initial", ElasticFigure::initial}, {"secant", ElasticFigure::secant}},
      "of the uniaxial test, that the reference gives: at 40-60 % of the peak, at 5-20 %, or to 50 %"),
    entry::choice("Poissons ratio", &P::poissons_ratio,
                  {{"secant", ElasticFigure::secant}, {"initial", ElasticFigure::initial}},
                  "of the uniaxial test, that the reference gives: to 50 % of the peak, or at 5-20 %"),
    entry::number(
      "Tolerance", &P::tolerance, {'(', 0.0, 0.5, ']'},
      "largest deviation from a target, over the target; the 95 % interval of the mean lies within it where the target is "
      "reached",
      {.basic = true}),
    entry::integer("Design points", &P::n_points, {'[', 4.0, 512.0, ']'},
                   "sets of parameters that are tested to learn how the strengths depend on them"),
    entry::integer("Design packings", &P::n_packings, {'[', 2.0, 64.0, ']'},
                   "on which each of them is tested; the same for all"),
    entry::integer("Step packings", &P::n_step_packings, {'[', 2.0, 256.0, ']'},
                   "on which each step after the design is confirmed"),
    entry::integer("Most steps", &P::most_steps, {'[', 1.0, 50.0, ']'}, "after the design"),
    entry::integer("Most packings", &P::most_packings, {'[', 3.0, 1000.0, ']'},
                   "fresh ones on which the answer is tested, until the 95 % intervals of the means are narrow enough"),
    entry::integer("Samples", &P::n_samples, {'[', 500.0, 1000000.0, ']'},
                   "of the posterior distribution of the parameters")};
}
} // namespace feldspar

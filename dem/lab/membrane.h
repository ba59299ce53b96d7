#pragma once

#include "dem/specimen/specimen.h"

#include <vector>

namespace feldspar
{
/// The sides of a specimen as a flexible membrane around them would touch them; docs/theory.md §4.3.
template <int dim>
struct LateralSurface
{
  Components<dim> inward_area; ///< of each grain its share of the sides, across the last axis [m²]; their sum is zero
  double cross_section;        ///< area within the membrane, mean over the height [m²]
};

/// Looks at the grains from outside, along rays to the axis through the middle: each grain gets the parts of the sides
/// where it is the first to be met. counts: whether a grain can be met; lower, upper: heights of the ends [m].
template <int dim>
LateralSurface<dim> lateral_surface(const Specimen<dim>& specimen, const std::vector<bool>& counts, double lower,
                                    double upper);
} // namespace feldspar

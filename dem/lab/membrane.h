#pragma once

#include "dem/specimen/specimen.h"

namespace feldspar
{
/// The side of a cylinder of grains as a flexible membrane around it would touch it; docs/theory.md §4.3.
struct LateralSurface
{
  Components<3> inward_area; ///< of each grain its share of the side, as a vector towards the axis [m²]
  double cross_section;      ///< area within the membrane, mean over the height [m²]
};

/// Looks at the grains from outside, along rays to the axis: each grain gets the parts of the side where it is the first
/// to be met, or, above a void, the nearest. lower, upper: heights of the ends [m].
LateralSurface lateral_surface(const Specimen<3>& specimen, double lower, double upper);
} // namespace feldspar

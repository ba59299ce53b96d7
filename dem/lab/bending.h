#pragma once

#include "dem/lab/test_in_progress.h"

namespace feldspar
{
/// A body that stands on two rollers and is pressed down by a third, with a saw cut of no width from below.
struct Bending
{
  double depth;             ///< from the plane of the lower rollers to the upper one [m]
  double span;              ///< between the lower rollers [m]
  double notch_depth;       ///< of the cut [m]
  double stress_over_force; ///< measured stress over the load [1/m²]
  NotchGeometry notch;
};

/// Stands the body, whose lower side is at 0 and whose middle is that of its box, on the rollers: smooth plates against the
/// grains that stand out most there. In the plane a plate is one mean grain diameter wide to either side; in space it is half
/// as wide and bedded, so that every grain within a mean radius of it bears as it lies. Throws InputError where there are
/// none.
template <int dim>
SetUpTest<dim> bend(Specimen<dim> body, const Bending& bending, const TestParameters& wanted,
                    const DynamicsParameters& dynamics);
} // namespace feldspar

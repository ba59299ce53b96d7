#pragma once

#include "dem/lab/laboratory_run.h"
#include "laboratory/own_entries.h"

#include <vector>

namespace feldspar
{
/// The pace of a body that is bent.
struct BendingParameters
{
  double strain_rate = 0.1;      ///< of the deflection over the depth of the body [1/s]
  double sampling_strain = 2e-6; ///< of the same between two rows of the curve
};

/// The entries of BendingParameters.
std::vector<Entry<TestParameters>> bending_entries();

/// A body that stands on two rollers and is pressed down by a third, with a saw cut of no width from below.
struct Bending
{
  double depth;                 ///< from the plane of the lower rollers to the upper one [m]
  double span;                  ///< between the lower rollers [m]
  double breadth;               ///< [m]
  double stress_over_force;     ///< measured stress over the load [1/m²]
  double intensity_over_stress; ///< as of NotchGeometry [√m]
  bool is_valid = true;         ///< the formula holds for the depth of the cut
};

/// Saws the notch, and stands the body, whose lower side is at 0 and whose middle is that of its box, on the rollers: smooth
/// plates, one mean grain diameter wide to either side in the plane and one mean radius in space, against the grain that
/// protrudes furthest of those that are not loose. They are bedded: every grain within a mean radius of them carries load as
/// it lies, or within as much more as it takes to have one on either side of the middle. They pivot, so that their forces
/// act at their middles. Throws InputError where there is no such grain.
template <int dim>
SetUpTest<dim> bend(Specimen<dim> body, const Bending& bending, const TestParameters& wanted,
                    const DynamicsParameters& dynamics);
} // namespace feldspar

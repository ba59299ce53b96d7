#pragma once

#include "laboratory/own_entries.h"

#include <optional>
#include <vector>

namespace feldspar
{
/// The reach of an event of acoustic emission: breaks within it are one.
struct EmissionParameters
{
  double event_radius = 1.0;       ///< over the mean grain diameter
  double event_duration = 2.0;     ///< over the time that a shear wave takes along the radius
  std::optional<double> thickness; ///< of a body in the plane; none: the width of the specimen [m]
};

/// The entries of EmissionParameters.
inline std::vector<Entry<TestParameters>> emission_entries()
{
  using P = EmissionParameters;
  using namespace tests_flags;
  return within_tests<P>(
    {entry::number(
       "Event radius", &P::event_radius, {'(', 0.0, 100.0, ']'},
       "in mean grain diameters. A break belongs to a running event if it is no farther from its centre than the "
       "farthest break of the event and this distance",
       of_grains),
     entry::number(
       "Event duration", &P::event_duration, {'(', 0.0, 100.0, ']'},
       "of an event after its last break, over the time that a shear wave takes from its centre to that distance",
       of_grains),
     entry::optional_quantity(
       "Thickness", &P::thickness, Measure::length, "mm", ranges::above_zero,
       "of a body in the plane, for the moments and energies of its events; none: the width of the "
       "specimen",
       {.varies = true, .bodies = {Body::plane_box}, .needs = "is of tests on plane specimens of grains"})});
}
} // namespace feldspar

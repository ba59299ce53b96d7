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
std::vector<Entry<TestParameters>> emission_entries();
} // namespace feldspar

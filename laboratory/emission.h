#pragma once

#include "laboratory/own_entries.h"

#include <array>
#include <cstdint>
#include <optional>
#include <vector>

namespace feldspar
{
/// What makes breaks one event of acoustic emission.
struct EmissionParameters
{
  double event_radius = 1.0;       ///< over the mean grain diameter
  double event_duration = 1.0;     ///< over the time that a shear wave takes along the radius
  std::optional<double> thickness; ///< of a body in the plane; none: the width of the specimen [m]
};

/// The entries of EmissionParameters.
std::vector<Entry<TestParameters>> emission_entries();

/// Breaks of segments near each other in place and time.
struct EmissionEvent
{
  std::uint64_t number = 0;         ///< from 1, in the order of the first breaks
  double time = 0.0;                ///< of the first break, since the strain was zero [s]
  double axial_strain = 0.0;        ///< of the specimen at the first break
  std::uint64_t n_tension = 0;      ///< breaks in tension
  std::uint64_t n_shear = 0;        ///< breaks in shear
  double released_energy = 0.0;     ///< by the breaks [J]
  std::array<double, 3> centroid{}; ///< mean of the places of the breaks [m]
  double extent = 0.0;              ///< largest distance of a break from the centroid [m]
  /// Moment tensor when its scalar moment was largest: xx, xy, xz, yy, yz, zz [N m].
  std::array<double, 6> moment{};

  std::uint64_t n_breaks() const { return n_tension + n_shear; }
};
} // namespace feldspar

#pragma once

#include "base/input_error.h"
#include "dem/dynamics/walls.h"
#include "dem/specimen/specimen.h"

#include <cstdint>
#include <optional>
#include <string>

/// Numbers that have gone wrong, recognised by motion that grains in contact cannot have.
namespace feldspar
{
/// The end of a simulation whose numbers have gone wrong. One line: the grain, the step, the likely reason.
struct Runaway : InputError
{
  using InputError::InputError;
};

/// A grain that moves or stands as none can, and how.
struct StrayGrain
{
  std::uint32_t grain;
  bool through_wall = false;
  double way_over_radius = 0.0; ///< in a step; 0 of one that stands or has been pressed where it cannot be

  std::string motion() const; ///< "goes ...", "stands ..."
};

/// The first of these grains that goes farther in a step of dt [s] than its radius, in translation or rolling
/// (rock waves move grains by millionths of that, and whoever goes so far has passed his neighbours before a force could
/// stop him); whose coordinates are no numbers or out of reach; or whose centre has gone through a wall.
template <int dim>
std::optional<StrayGrain> find_stray_grain(const Specimen<dim>& body, const GrainRange& own, const Walls<dim>& walls,
                                           double dt);

/// The circumstances in which numbers went wrong.
struct Circumstances
{
  std::uint64_t step;
  double dt;                   ///< [s]
  double share_of_stable_step; ///< dt over the least root of mass over stiffness, as contacts are now
  double loading_speed;        ///< of the fastest wall, grip or side of the cell [m/s]
  double smallest_radius;      ///< [m]
  bool through_wall = false;   ///< a grain that was slow has been pressed through a wall
};

/// The sentence about it: `trouble`, step and likely reason.
std::string describe_runaway(const std::string& trouble, const Circumstances& circumstances);
} // namespace feldspar

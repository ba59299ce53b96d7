#pragma once

#include "dem/dynamics/dynamics.h"
#include "dem/lab/laboratory_run.h"
#include "dem/lab/platens.h"
#include "dem/lab/servo.h"
#include "laboratory/own_entries.h"
#include "laboratory/parameters.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <functional>
#include <optional>
#include <vector>

namespace feldspar
{
/// The lateral boundary of a specimen in a triaxial test.
enum class LateralBoundary
{
  wall,    ///< rigid walls, or a rigid cylinder that shrinks and widens
  membrane ///< a pressure on the outer grains, each by its share of the side
};

/// The confinement of a body that is pressed between platens.
struct ConfinementParameters
{
  LateralBoundary lateral_boundary = LateralBoundary::wall;
  std::optional<double> intermediate_stress; ///< σ_2 on a box in space, compression positive [Pa]; none: σ_3
};

/// The entries of ConfinementParameters.
std::vector<Entry<TestParameters>> confinement_entries();

/// Walls that press together on an area with one pressure.
template <int dim>
struct Press
{
  std::vector<std::size_t> walls;
  std::function<double(const Dynamics<dim>&)> area; ///< of each [m²]
  double pressure;                                  ///< compression positive [Pa]
};

/// Mean over its walls [Pa], tension positive.
template <int dim>
double stress_of(const Dynamics<dim>& dynamics, const Press<dim>& press)
{
  double force = 0.0;
  for (const std::size_t wall : press.walls)
    force += dynamics.wall_force(wall) / double(press.walls.size());
  return -force / press.area(dynamics);
}

/// Moves the walls of a press so that their pressures come to a target [Pa], as hold_pressure().
template <int dim>
void hold(Dynamics<dim>& dynamics, const Press<dim>& press, const double target, const double largest_speed)
{
  const double area = press.area(dynamics);
  for (const std::size_t wall : press.walls)
    hold_pressure(dynamics, wall, area, target, largest_speed);
}

/// The largest deviation of the pressure on a wall from a target [Pa], relative.
template <int dim>
double deviation(const Dynamics<dim>& dynamics, const Press<dim>& press, const double target)
{
  double largest = 0.0;
  for (const std::size_t wall : press.walls)
    largest = std::max(largest, std::abs(dynamics.wall_force(wall) / press.area(dynamics) / target - 1.0));
  return largest;
}

/// The lateral boundary of a specimen that is pressed between platens.
template <int dim>
struct Surroundings
{
  std::vector<Press<dim>> sides; ///< the first holds the confining pressure; none with a membrane
  std::optional<double> intermediate_stress = std::nullopt; ///< where a side holds another [Pa]
  std::function<double(const Dynamics<dim>&)> end_area;
  /// Puts this share of the pressures on the grains that lie at the sides now; empty with walls.
  std::function<void(Dynamics<dim>&, double share)> press_membrane = {};
};

/// Stands the walls around the sides of a specimen between two platens, for a confining pressure [Pa].
template <int dim>
Surroundings<dim> surround(SetUpTest<dim>& test, const WallPair& ends, double confining_pressure,
                           const TestParameters& wanted);
} // namespace feldspar

#pragma once

#include "dem/dynamics/dynamics.h"
#include "dem/lab/laboratory_run.h"
#include "dem/lab/seating.h"

namespace feldspar
{
/// Two walls across one axis, such as the platens below and above a specimen.
struct WallPair
{
  std::size_t low;
  std::size_t high;
};

/// Stands both platens at rest across the last axis, at the ends of a specimen that leads from one to the other.
template <int dim>
WallPair add_platens(SetUpTest<dim>& test, const double friction)
{
  constexpr int axis = dim - 1;
  const Specimen<dim>& body = test.dynamics.specimen();
  check_leads_from_end_to_end(body);
  return {stand_wall<dim>(test, {axis, 1.0, 0.0, 0.0, friction}, "lower platen"),
          stand_wall<dim>(test, {axis, -1.0, body.size[axis], 0.0, friction}, "upper platen")};
}

/// Distance between the walls of a pair [m].
template <int dim>
double distance(const Dynamics<dim>& dynamics, const WallPair& pair)
{
  return dynamics.walls()[pair.high].position - dynamics.walls()[pair.low].position;
}

/// Brings the walls together at `speed` [m/s], half of it each.
template <int dim>
void close(Dynamics<dim>& dynamics, const WallPair& pair, const double speed)
{
  dynamics.wall(pair.low).velocity = 0.5 * speed;
  dynamics.wall(pair.high).velocity = -0.5 * speed;
}

/// The stress at both walls, on an area [m²].
template <int dim>
EndStress stress_of(const Dynamics<dim>& dynamics, const WallPair& pair, const double area)
{
  return {-dynamics.wall_force(pair.low) / area, -dynamics.wall_force(pair.high) / area};
}

/// Halfway between them [m].
template <int dim>
double middle(const Dynamics<dim>& dynamics, const WallPair& pair)
{
  return 0.5 * (dynamics.walls()[pair.low].position + dynamics.walls()[pair.high].position);
}

/// Gives the grains, on top of what they have, the velocities of a steady, uniform stretch [1/s] about a place of the last axis
/// [m]: set off from rest, the ends would send waves through the specimen that spoil the first tenth of the curve.
template <int dim>
void start_steadily(Dynamics<dim>& dynamics, const double strain_rate, const double about)
{
  constexpr int axis = dim - 1;
  dynamics.know_all_motions();
  const auto& grains = dynamics.specimen().grains;
  for (std::uint32_t i = 0; i < grains.size(); ++i)
    dynamics.push(i, strain_rate * (grains.position[axis][i] - about) * Vector<dim>::Unit(axis));
}

/// About the middle of the specimen's box.
template <int dim>
void start_steadily(Dynamics<dim>& dynamics, const double strain_rate)
{
  start_steadily(dynamics, strain_rate, 0.5 * dynamics.specimen().size[dim - 1]);
}
} // namespace feldspar

#pragma once

#include "dem/dynamics/energy_ledger.h"
#include "dem/dynamics/parameters.h"
#include "dem/sharing/body_share.h"
#include "dem/specimen/specimen.h"

#include <array>
#include <cmath>
#include <cstdint>
#include <limits>
#include <utility>
#include <vector>

namespace feldspar
{
/// A rigid plane across one axis, on which grains lie from one side; or a smooth cylinder about the last axis through
/// the middle of the specimen, whose coordinate is the distance from that axis.
struct Wall
{
  int axis = 0;
  double side = 1.0;     ///< +1: grains lie towards larger coordinates, -1: towards smaller ones
  double position = 0.0; ///< [m]
  double velocity = 0.0; ///< along its coordinate [m/s]
  double friction = 0.0;
  double servo_integral = 0.0; ///< inwards, of whoever holds its pressure [m/s]
  bool round = false;          ///< the cylinder
  bool pivots = false; ///< a smooth plate with two ends that turns freely about its middle, where its force acts
  double tilt = 0.0;   ///< of a plate that pivots: its end at the larger coordinate away from the grains [rad]
  double bed = 0.0;    ///< plaster: fills gaps of up to this to grains that are placed, at the first search [m]
  /// The extent of a plate that is not endless along extent_axis(), from and to [m].
  std::array<double, 2> extent{-std::numeric_limits<double>::infinity(), std::numeric_limits<double>::infinity()};

  /// Returns whether the wall is a plate with an end. The grains above a plate are found with each search for contacts.
  bool ends() const { return std::isfinite(extent[0]) || std::isfinite(extent[1]); }
  /// About which a plate with two ends pivots, along extent_axis() [m].
  double middle() const { return 0.5 * (extent[0] + extent[1]); }
};

/// Axis along which a plate may end: the last axis, or the first for one that lies across the last.
template <int dim>
int extent_axis(const Wall& wall)
{
  return wall.axis == dim - 1 ? 0 : dim - 1;
}

/// The side of a cylinder.
template <int dim>
Wall round_wall(const Specimen<dim>& specimen)
{
  return {.side = -1.0, .position = 0.5 * specimen.size[0], .round = true};
}

/// Direction in which the coordinate of a wall grows.
template <int dim>
Vector<dim> wall_direction(const Specimen<dim>& body, const Wall& wall, std::uint32_t grain);
/// Coordinate of a grain across the wall [m].
template <int dim>
double wall_coordinate(const Specimen<dim>& body, const Wall& wall, std::uint32_t grain);

/// The smallest gap between a wall and those grains in front of it that count [m]: negative where one lies in the wall, infinite
/// where there is none. `counts`: [n_grains].
template <int dim>
double gap_at(const Specimen<dim>& body, const Wall& wall, const std::vector<bool>& counts);

/// A grain near a wall.
template <int dim>
struct WallTouch
{
  std::uint32_t grain;
  double zero_distance;      ///< distance from the wall below which it presses [m]; beyond its radius on a bed
  double lever = 0.0;        ///< from the middle of a plate that pivots, where it came to the plate [m]
  double overlap = 0.0;      ///< [m]
  double normal_force = 0.0; ///< at the last press() [N]
  std::array<double, dim - 1> shear_force{};
  double slip_energy = 0.0;
};

/// The walls about a body, and the grains near each.
template <int dim>
class Walls
{
public:
  std::size_t add(const Wall& wall);
  std::size_t size() const { return walls.size(); }
  const std::vector<Wall>& list() const { return walls; }
  Wall& operator[](const std::size_t i) { return walls[i]; }
  const Wall& operator[](const std::size_t i) const { return walls[i]; }

  /// Sum of the grains' pressure on a wall [N], compression positive.
  double force(const std::size_t wall) const { return forces[wall]; }
  /// Pressure of each grain of this process near a wall [N].
  std::vector<double> pressures(std::size_t wall) const;
  /// Normal stiffness of each where it presses, else 0 [N/m].
  std::vector<double> stiffnesses_in_touch(const Specimen<dim>& body, std::size_t wall) const;
  /// Sets the force on a wall and the stiffness of its contacts to the sums of those of all processes.
  void set_sums(std::size_t wall, const std::vector<double>& pressures, const std::vector<double>& stiffnesses);
  /// Normal stiffness of a grain at a wall [N/m].
  static double stiffness(const Specimen<dim>& body, double radius);
  /// Sum of the normal stiffnesses of a wall's pressing contacts [N/m].
  double stiffness_in_touch(const Specimen<dim>& body, std::size_t wall) const;

  /// visit(wall, touch) for each grain near a wall, wall by wall.
  template <typename Visit>
  void for_each_touch(Visit&& visit) const
  {
    for (std::size_t w = 0; w < walls.size(); ++w)
      for (const auto& touch : touches[w])
        visit(walls[w], touch);
  }

  /// Notes the grains within `skin` [m] of each wall, and on a bed those that were placed there; images, which stand behind
  /// the body's own, are none of them. A plate that pivots keeps the grains that press it, also where they leave its
  /// extent, and the others that it has until they are half its width away from it.
  void search(const Specimen<dim>& body, const GrainRange& own, double skin, ZeroForce zero_force,
              EnergyLedger& ledger);
  /// Takes these grains, by number, for all near a wall.
  void take(const std::size_t wall, std::vector<WallTouch<dim>> all) { touches[wall] = std::move(all); }
  const std::vector<WallTouch<dim>>& near(const std::size_t wall) const { return touches[wall]; }
  /// Forgets them.
  void clear();
  /// Distance that a wall has moved since the last search, at the ends of a plate that has tilted [m].
  double way_since_search(std::size_t wall) const;
  /// The smallest gap between a wall and the grains that were not near it at the last search [m].
  double smallest_gap_not_listed(const Specimen<dim>& body, const GrainRange& own, std::size_t wall) const;

  void move(const double dt)
  {
    for (Wall& wall : walls)
      wall.position += dt * wall.velocity;
  }
  /// Presses the grains, whose forces and couples it adds to; returns whether one has come into contact.
  bool press(double dt, Specimen<dim>& body, const BodyShare<dim>& share);

  /// Adds what the contacts store and have dissipated.
  void add_energies(EnergySums& sums, const Specimen<dim>& body) const;

  template <typename Archive>
  void transfer(Archive& archive)
  {
    archive.array("walls", walls);
    archive.array("wall_forces", forces);
    archive.array("wall_position_at_search", position_at_search);
    archive.array("wall_tilt_at_search", tilt_at_search);
  }

private:
  double stored_energy(const Specimen<dim>& body, const WallTouch<dim>& touch) const; ///< [J]
  /// Tilts a plate that pivots.
  void balance(const Specimen<dim>& body, const BodyShare<dim>& share, std::size_t wall);

  std::vector<Wall> walls;
  std::vector<std::vector<WallTouch<dim>>> touches; ///< of each wall, by grain
  std::vector<double> forces;
  std::vector<double> shared_stiffnesses; ///< of the contacts of each wall with a shared body [N/m]; else empty
  std::vector<double> position_at_search; ///< [m]
  std::vector<double> tilt_at_search;     ///< [rad]
};
} // namespace feldspar

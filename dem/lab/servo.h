#pragma once

#include "base/parameter_id.h"
#include "dem/dynamics/dynamics.h"
#include "laboratory/kinds.h"

#include <cmath>
#include <functional>
#include <string>

namespace feldspar
{
/// The speed inwards of a wall that mends half of a missing force [N] in one step, which its stiffness [N/m] resists, plus
/// an integral of that speed, which grows by 0.05 of it; each within ±`largest` [m/s].
double servo_speed(double missing_force, double stiffness, double time_step, double largest, double& integral);

/// Moves a wall so that its pressure comes to a target: v = e + I with e = G (P_0 - P), I += 0.05 e, both within
/// ±largest_speed; docs/theory.md §4.3. The proportional part alone lags behind a specimen that widens steadily.
template <int dim>
void hold_pressure(Dynamics<dim>& dynamics, const std::size_t wall, const double area, const double target,
                   const double largest_speed)
{
  Wall& moved = dynamics.wall(wall);
  moved.velocity =
    moved.side * servo_speed(target * area - dynamics.wall_force(wall), dynamics.wall_stiffness_in_touch(wall),
                             dynamics.time_step(), largest_speed, moved.servo_integral);
}

/// Pressures on walls that are raised together.
struct PressureRamp
{
  double pressure;                           ///< compression positive, for the words of an error [Pa]
  double duration;                           ///< of the rise [s]
  std::function<void(double)> hold;          ///< this share of the pressures, for one step
  std::function<double()> largest_deviation; ///< of a wall's pressure from its target, relative
  ParameterId asked_by = parameter_id<&TestCase::confining_pressure>();
  double tolerance = 0.005; ///< of the largest deviation at the end
  std::string failure = {}; ///< the error where that is not reached; empty: of walls that cannot hold the pressure
};

/// The speed of a wave along a rod of the specimen's rock, by the modulus of its particle contacts [m/s].
template <int dim>
double wave_speed(const Specimen<dim>& specimen)
{
  return std::sqrt(specimen.particle_contact.modulus / specimen.bulk_density);
}

/// Raises the pressures in proportion to time, so as not to hit the specimen, and goes on until half a ramp more has passed
/// and all are held within the tolerance. `check` is called before each step and may throw. Throws InputError where they are not
/// held after 20 ramps.
template <int dim>
void raise_pressures(Dynamics<dim>& dynamics, const PressureRamp& ramp, const std::function<void()>& check);
} // namespace feldspar

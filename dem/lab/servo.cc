#include "dem/lab/servo.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace feldspar
{
double servo_speed(const double missing_force, const double stiffness, const double time_step, const double largest,
                   double& integral)
{
  constexpr double integral_share = 0.05;
  const auto within = [=](const double speed) { return std::clamp(speed, -largest, largest); };
  const double proportional = stiffness > 0.0 ? within(0.5 * missing_force / (stiffness * time_step)) : largest;
  integral = within(integral + integral_share * proportional);
  return within(proportional + integral);
}

template <int dim>
void raise_pressures(Dynamics<dim>& dynamics, const PressureRamp& ramp, const std::function<void()>& check)
{
  constexpr double most_ramps = 20.0;
  do
    {
      check();
      ramp.hold(std::min(1.0, dynamics.time() / ramp.duration));
      dynamics.step();
      if (dynamics.time() > most_ramps * ramp.duration)
        throw ParameterError(ramp.asked_by,
                             ramp.failure.empty()
                               ? fmt::format("the walls cannot hold {:g} MPa on this specimen", ramp.pressure / 1e6)
                               : ramp.failure);
    }
  while (dynamics.time() < 1.5 * ramp.duration || ramp.largest_deviation() >= ramp.tolerance);
}

template void raise_pressures<2>(Dynamics<2>&, const PressureRamp&, const std::function<void()>&);
template void raise_pressures<3>(Dynamics<3>&, const PressureRamp&, const std::function<void()>&);
} // namespace feldspar

#include "dem/lab/servo.h"

#include <algorithm>

namespace feldspar
{
template <int dim>
void hold_pressure(Dynamics<dim>& dynamics, const std::size_t wall, const double area, const double target,
                   const double largest_speed)
{
  constexpr double integral_share = 0.05;
  const auto within = [=](const double speed) { return std::clamp(speed, -largest_speed, largest_speed); };
  // Half of the speed that would mend the error in one step.
  const double stiffness = dynamics.wall_stiffness_in_touch(wall);
  const double missing_force = target * area - dynamics.wall_force(wall);
  const double proportional =
    stiffness > 0.0 ? within(0.5 * missing_force / (stiffness * dynamics.time_step())) : largest_speed;
  Wall& moved = dynamics.wall(wall);
  moved.servo_integral = within(moved.servo_integral + integral_share * proportional);
  moved.velocity = moved.side * within(proportional + moved.servo_integral);
}

template void hold_pressure<2>(Dynamics<2>&, std::size_t, double, double, double);
template void hold_pressure<3>(Dynamics<3>&, std::size_t, double, double, double);
} // namespace feldspar

#include "dem/lab/machine.h"

#include "base/parameter_id.h"
#include "dem/lab/servo.h"

#include <fmt/format.h>

#include <algorithm>

namespace feldspar
{
template <int dim>
Machine machine_of(SetUpTest<dim>& test, const WallPair& platens, const CompressionParameters& wanted)
{
  const Specimen<dim>& body = test.dynamics.specimen();
  const double height = distance(test.dynamics, platens);
  const double area = body.volume() / body.size[dim - 1];
  const double modulus = body.particle_contact.modulus; // about that of the body
  Machine machine{platens,
                  height,
                  middle(test.dynamics, platens),
                  wanted.strain_rate,
                  wanted.strain_rate,
                  wanted.machine_stiffness,
                  std::nullopt};
  if (const auto& laboratory = wanted.loading_rate)
    {
      const bool is_travel = laboratory->of == LoadingRate::Of::travel;
      const double rate = laboratory->of == LoadingRate::Of::force ? laboratory->value / area : laboratory->value;
      const double strain_rate = rate / (is_travel ? height : modulus);
      machine.strain_rate = machine.strain_rate_at_start = std::max(strain_rate, wanted.strain_rate);
      if (!is_travel)
        test.loading.stress_rate = *(machine.stress_rate = modulus * machine.strain_rate);
      test.loading.rate_over_laboratory = machine.strain_rate / strain_rate;
    }
  constexpr double softest = 1e-3; // of the body's: the crosshead travels, and the run takes, a thousand times as far
  if (const double of_body = modulus * area / height; machine.stiffness && *machine.stiffness < softest * of_body)
    throw ParameterError(
      parameter_id<&CompressionParameters::machine_stiffness>(), fmt::format("{:g} kN/mm", *machine.stiffness / 1e6),
      fmt::format("a machine so much softer than the body, of some {:.3g} kN/mm, would not end; give at "
                  "least {:.3g} kN/mm",
                  of_body / 1e6, softest * of_body / 1e6));
  if (machine.stiffness)
    machine.strain_rate_at_start *= *machine.stiffness / (*machine.stiffness + modulus * area / height);
  test.loading.strain_rate = -machine.strain_rate;
  test.loading.sampling_strain = wanted.sampling_strain;
  if (!machine.is_rigid())
    test.loading.shortening = [=](const Dynamics<dim>& state) { return 1.0 - distance(state, platens) / height; };
  return machine;
}

template <int dim>
void start(Dynamics<dim>& dynamics, const Machine& machine)
{
  start_steadily(dynamics, -machine.strain_rate_at_start, machine.middle);
  close(dynamics, machine.platens, machine.strain_rate_at_start * machine.height);
  dynamics.wall(machine.platens.low).servo_integral = 0.5 * machine.strain_rate_at_start * machine.height;
}

template <int dim>
void press(Dynamics<dim>& dynamics, const Machine& machine, const double pressure, const double area,
           const SinceStart& since)
{
  if (dynamics.n_steps() == 0)
    return; // nothing presses yet, and the step in time is not known
  const auto [low, high] = machine.platens;
  const double spring = machine.stiffness.value_or(0.0);
  const double travel = machine.height * (machine.strain_rate * since.time + since.axial_strain); // taken by the spring
  const double wanted = area * (pressure + machine.stress_rate.value_or(0.0) * since.time) + spring * travel;
  const double missing = wanted - 0.5 * (dynamics.wall_force(low) + dynamics.wall_force(high));
  const Specimen<dim>& body = dynamics.specimen();
  // Stiffness of the contacts; that of the body where no grain presses yet, or any more.
  const double of_contacts =
    std::max(0.5 * (dynamics.wall_stiffness_in_touch(low) + dynamics.wall_stiffness_in_touch(high)),
             body.particle_contact.modulus * area / machine.height);
  // A pump follows a body until that gives way five times as fast as when it is whole; beyond, where nothing can hold the
  // force, it does not drive the pieces into each other. A spring pushes as fast as the body gives way.
  constexpr double fastest_pump = 5.0;
  const double largest_speed =
    machine.stress_rate ? fastest_pump * 0.5 * machine.strain_rate * machine.height : 0.01 * wave_speed(body);
  close(dynamics, machine.platens,
        2.0 * servo_speed(missing, of_contacts + 2.0 * spring, dynamics.time_step(), largest_speed,
                          dynamics.wall(low).servo_integral));
}

template Machine machine_of<2>(SetUpTest<2>&, const WallPair&, const CompressionParameters&);
template Machine machine_of<3>(SetUpTest<3>&, const WallPair&, const CompressionParameters&);
template void start<2>(Dynamics<2>&, const Machine&);
template void start<3>(Dynamics<3>&, const Machine&);
template void press<2>(Dynamics<2>&, const Machine&, double, double, const SinceStart&);
template void press<3>(Dynamics<3>&, const Machine&, double, double, const SinceStart&);
} // namespace feldspar

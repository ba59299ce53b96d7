#include "dem/lab/laboratory_run.h"
#include "dem/lab/machine.h"
#include "dem/lab/protocols/protocols.h"
#include "dem/lab/servo.h"
#include "dem/lab/surroundings.h"
#include "laboratory/compression.h"
#include "laboratory/entries.h"

#include <algorithm>
#include <functional>
#include <utility>

namespace feldspar
{
namespace
{
template <int dim>
SetUpTest<dim> set_up_triaxial_compression(Specimen<dim> specimen, const double confining_pressure,
                                           const TestParameters& wanted, const DynamicsParameters& dynamics)
{
  SetUpTest<dim> test{Dynamics<dim>(std::move(specimen), dynamics, ZeroForce::as_placed), {}};
  const WallPair ends = add_platens(test, wanted.platen_friction);
  const double height = distance(test.dynamics, ends);
  const Machine machine = machine_of(test, ends, wanted.of<CompressionParameters>());
  const double largest_servo_speed = 20.0 * 0.5 * (machine.strain_rate * height);
  const auto around = surround(test, ends, confining_pressure, wanted);
  const bool membrane = bool(around.press_membrane);
  // Fitting the membrane anew at every step would change the ends' area by nothing to speak of.
  const double area_at_rest = membrane ? around.end_area(test.dynamics) : 0.0;
  const auto held_area = [=](const Dynamics<dim>& state) { return membrane ? area_at_rest : around.end_area(state); };
  const Press<dim> end_press{{ends.low, ends.high}, held_area, confining_pressure};

  const auto hold_share = [=](Dynamics<dim>& state, const Press<dim>& press, const double share) {
    hold(state, press, share * press.pressure, largest_servo_speed);
  };
  const auto membrane_is_due = [=](const Dynamics<dim>& state) {
    constexpr std::uint64_t steps_between_fits = 200; // the grains move by thousandths of a radius meanwhile
    return membrane && state.n_steps() % steps_between_fits == 0;
  };

  test.loading.seat = [=](Dynamics<dim>& state, const std::function<void()>& check) {
    const auto hold_all = [&](const double share) {
      for (const auto& side : around.sides)
        hold_share(state, side, share);
      if (membrane_is_due(state) || (membrane && share < 1.0 && state.n_steps() % 20 == 0))
        around.press_membrane(state, share);
      hold_share(state, end_press, share);
    };
    const auto largest_deviation = [&] {
      double largest = deviation(state, end_press, end_press.pressure);
      for (const auto& side : around.sides)
        largest = std::max(largest, deviation(state, side, side.pressure));
      return largest;
    };
    raise_pressures<dim>(state,
                         {confining_pressure, wanted.seating_transits * height / wave_speed(state.specimen()), hold_all,
                          largest_deviation},
                         check);
    if (membrane)
      around.press_membrane(state, 1.0);
    start(state, machine);
  };
  test.loading.drive = [=](Dynamics<dim>& state, const SinceStart& since) {
    for (const auto& side : around.sides)
      hold_share(state, side, 1.0);
    if (membrane_is_due(state))
      around.press_membrane(state, 1.0);
    if (!machine.is_rigid())
      press(state, machine, confining_pressure, held_area(state), since);
  };

  test.loading.intermediate_stress = around.intermediate_stress;
  test.loading.end_stress = [=](const Dynamics<dim>& state) { return stress_of(state, ends, around.end_area(state)); };
  if (!membrane)
    test.loading.servo_stress = [side = around.sides.front()](const Dynamics<dim>& state) {
      return stress_of(state, side);
    };
  return test;
}
} // namespace

constinit const LaboratoryProtocol triaxial_compression = complete({
  .kind = {.name = "triaxial_compression",
           .title = "Triaxial compression",
           .strength = "strength",
           .sign = -1.0,
           .envelope_role = EnvelopeRole::compression,
           .has_uniform_stress = true,
           .takes_confining_pressure = true,
           .runs_on_finite_elements = true,
           .duration_rank = 1},
  .strain_rate = rate_of<CompressionParameters>,
  .own_entries = {compression_entries, machine_entries, confinement_entries, platen_entries, seating_entries},
  .forecast = {PeakForecast::With::compression},
  .takes_cylinders = true,
  .takes_clumps = true,
  .set_ups = {set_up_triaxial_compression<2>, set_up_triaxial_compression<3>},
});
} // namespace feldspar

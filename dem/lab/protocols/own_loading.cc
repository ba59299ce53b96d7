#include "base/parameter_id.h"
#include "dem/lab/laboratory_run.h"
#include "dem/lab/platens.h"
#include "dem/lab/protocols/protocols.h"
#include "dem/lab/servo.h"
#include "dem/lab/surroundings.h"
#include "laboratory/compression.h"
#include "laboratory/entries.h"
#include "laboratory/loading_stages.h"

#include <algorithm>
#include <utility>

namespace feldspar
{
namespace
{
template <int dim>
SetUpTest<dim> set_up_own_loading(Specimen<dim> specimen, double /*confining_pressure*/, const TestParameters& wanted,
                                  const DynamicsParameters& dynamics)
{
  const auto& stages = wanted.of<LoadingTable>().stages;
  const auto own = wanted.of<CompressionParameters>();
  if (stages.empty())
    throw ParameterError(parameter_id<&LoadingTable::file>(), "is missing; own_loading follows its stages");
  const LoadingStage& first = stages.front();
  const double pressure_at_start = wanted.of<LoadingTable>().pressure_at_start.value_or(first.confining_pressure);
  double fastest = 0.0;
  for (const LoadingStage& stage : stages)
    fastest = std::max(fastest, stage.lateral_strain ? own.strain_rate : stage.strain_rate.value_or(own.strain_rate));
  const double area = specimen.volume() / specimen.size[dim - 1];
  SetUpTest<dim> test{Dynamics<dim>(std::move(specimen), dynamics, ZeroForce::as_placed), {}};
  const WallPair ends = add_platens(test, wanted.platen_friction);
  const double height = distance(test.dynamics, ends);
  const double about = middle(test.dynamics, ends);
  const double largest_servo_speed = 20.0 * 0.5 * fastest * height;
  Surroundings<dim> around;
  if (pressure_at_start > 0.0)
    around = surround(test, ends, pressure_at_start, wanted);
  else
    around.end_area = [area](const Dynamics<dim>&) { return area; };

  const Press<dim> end_press{{ends.low, ends.high}, around.end_area, pressure_at_start};
  const auto hold_sides = [=](Dynamics<dim>& state, const double pressure) {
    for (const Press<dim>& side : around.sides)
      hold(state, side, pressure, largest_servo_speed);
  };

  test.loading.strain_rate = -own.strain_rate;
  test.loading.seat = [=](Dynamics<dim>& state, const std::function<void()>& check) {
    if (pressure_at_start > 0.0)
      {
        const auto largest_deviation = [&] {
          double largest = deviation(state, end_press, pressure_at_start);
          for (const Press<dim>& side : around.sides)
            largest = std::max(largest, deviation(state, side, pressure_at_start));
          return largest;
        };
        const auto hold_all = [&](const double share) {
          hold_sides(state, share * pressure_at_start);
          hold(state, end_press, share * pressure_at_start, largest_servo_speed);
        };
        raise_pressures<dim>(state,
                             {pressure_at_start, wanted.seating_transits * height / wave_speed(state.specimen()),
                              hold_all, largest_deviation, parameter_id<&LoadingTable::file>()},
                             check);
      }
    const bool presses = first.axial_strain ? *first.axial_strain > 0.0 : first.axial_stress > pressure_at_start;
    if (presses && !first.duration)
      start_steadily(state, -first.strain_rate.value_or(own.strain_rate), about);
  };
  // The widening responds to the platens after some half of a wave's travel. Mending in it less than a sixth of what is
  // missed leaves the loop stable even where a broken specimen widens by several times what it is shortened.
  const double closing_per_widening = 0.3 * wave_speed(test.dynamics.specimen()) / height; // [1/s]
  test.loading.drive_stage = [=](Dynamics<dim>& state, const StageDemand& demand) {
    hold_sides(state, demand.confining_pressure);
    if (demand.held_stress)
      hold(state, end_press, *demand.held_stress, largest_servo_speed);
    else if (demand.missing_widening)
      {
        const EndStress stress = stress_of(state, ends, around.end_area(state));
        const bool may_open = -0.5 * (stress.lower + stress.upper) > demand.confining_pressure;
        const double rate = closing_per_widening * *demand.missing_widening;
        close(state, ends, (may_open ? rate : std::max(0.0, rate)) * height);
      }
    else
      close(state, ends, demand.closing_rate * height);
  };
  test.loading.shortening = [=](const Dynamics<dim>& state) { return 1.0 - distance(state, ends) / height; };
  test.loading.sampling_strain = own.sampling_strain;
  test.loading.end_stress = [=](const Dynamics<dim>& state) { return stress_of(state, ends, around.end_area(state)); };
  if (!around.sides.empty())
    test.loading.servo_stress = [side = around.sides.front()](const Dynamics<dim>& state) {
      return stress_of(state, side);
    };
  return test;
}
} // namespace

constinit const LaboratoryProtocol own_loading = complete({
  .kind = {.name = "own_loading",
           .title = "Own loading",
           .strength = "highest axial stress",
           .sign = -1.0,
           .runs_on_finite_elements = true,
           .follows_stages = true},
  .strain_rate = rate_of<CompressionParameters>,
  .own_entries = {compression_entries, loading_table_entries, platen_entries, seating_entries},
  .takes_cylinders = true,
  .set_ups = {set_up_own_loading<2>, set_up_own_loading<3>},
});
} // namespace feldspar

#include "dem/lab/laboratory_run.h"
#include "dem/lab/platens.h"
#include "dem/lab/protocols/parameters.h"
#include "dem/lab/protocols/protocols.h"
#include "dem/lab/servo.h"
#include "laboratory/entries.h"
#include "laboratory/own_entries.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

namespace feldspar
{
namespace
{
/// The two ends of one half of the box.
template <int dim>
WallPair add_half_box(SetUpTest<dim>& test, const double from, const double to)
{
  Wall low{.axis = 0, .side = 1.0, .position = 0.0};
  Wall high{.axis = 0, .side = -1.0, .position = test.dynamics.specimen().size[0]};
  low.extent = high.extent = {from, to};
  const std::size_t first = stand_wall(test, low, "left end of a half of the box");
  return {first, stand_wall(test, high, "right end of a half of the box")};
}

/// The force of a half on its grains along the first axis [N].
template <int dim>
double push(const Dynamics<dim>& dynamics, const WallPair& half)
{
  return dynamics.wall_force(half.low) - dynamics.wall_force(half.high);
}

template <int dim>
SetUpTest<dim> set_up_direct_shear(Specimen<dim> specimen, const double normal_stress, const TestParameters& wanted,
                                   const DynamicsParameters& dynamics)
{
  constexpr int axis = dim - 1;
  const auto own = wanted.of<ShearParameters>();
  const double height = specimen.size[axis];
  const double area = specimen.size[0] * (dim == 2 ? specimen.thickness : specimen.size[1]);
  const double speed = own.strain_rate * specimen.size[0];
  // The halves leave one mean grain diameter free, so that the plane may run between them as it will.
  const double half_gap = specimen.report.mean_radius;
  constexpr double endless = std::numeric_limits<double>::infinity();

  SetUpTest<dim> test{Dynamics<dim>(std::move(specimen), dynamics, ZeroForce::as_placed), {}};
  const WallPair platens = add_platens(test, 0.0);
  const WallPair lower = add_half_box(test, -endless, 0.5 * height - half_gap);
  const WallPair upper = add_half_box(test, 0.5 * height + half_gap, endless);

  const double largest_servo_speed = 10.0 * speed;
  const auto hold = [=](Dynamics<dim>& state, const double pressure) {
    hold_pressure(state, platens.high, area, pressure, largest_servo_speed);
  };
  test.loading.seat = [=](Dynamics<dim>& state, const std::function<void()>& check) {
    const auto largest_deviation = [&] {
      double largest = 0.0;
      for (const std::size_t platen : {platens.low, platens.high})
        largest = std::max(largest, std::abs(state.wall_force(platen) / area / normal_stress - 1.0));
      return largest;
    };
    raise_pressures<dim>(state,
                         {normal_stress, wanted.seating_transits * height / wave_speed(state.specimen()),
                          [&](const double share) { hold(state, share * normal_stress); }, largest_deviation},
                         check);
    for (const std::size_t end : {upper.low, upper.high})
      state.wall(end).velocity = 0.5 * speed;
    for (const std::size_t end : {lower.low, lower.high})
      state.wall(end).velocity = -0.5 * speed;
  };
  if (own.normal_stiffness)
    {
      test.loading.normal_stiffness = own.normal_stiffness;
      test.loading.opening = [=](const Dynamics<dim>& state) { return distance(state, platens) - height; };
    }
  test.loading.drive = [=, stiffness = own.normal_stiffness.value_or(0.0)](Dynamics<dim>& state,
                                                                           const SinceStart& since) {
    hold(state, std::max(0.0, normal_stress + stiffness * since.opening)); // platens do not pull
  };

  test.loading.strain_rate = -own.strain_rate;
  test.loading.sampling_strain = own.sampling_strain;
  test.loading.end_stress = [=](const Dynamics<dim>& state) {
    return EndStress{push(state, lower) / area, -push(state, upper) / area};
  };
  test.loading.servo_stress = [=](const Dynamics<dim>& state) { return -state.wall_force(platens.high) / area; };
  return test;
}
std::vector<Entry<TestParameters>> shear_entries()
{
  using P = ShearParameters;
  using namespace tests_flags;
  return within_tests<P>(
    {entry::quantity("Shear strain rate", &P::strain_rate, Measure::rate, "1/s", ranges::above_zero,
                     "of the shear displacement over the length of the plane; magnitude", of_grains),
     entry::number("Shear sampling strain", &P::sampling_strain, range_of_sampling_strain,
                   "shear displacement over the length of the plane between two rows of the curve", of_grains),
     entry::optional_quantity("Shear normal stiffness", &P::normal_stiffness, Measure::stiffness, "GPa/mm",
                              ranges::above_zero,
                              "of the rock around the plane of direct shear: the normal stress grows by this times the "
                              "opening of the box since its seating; none: the normal stress is constant",
                              of_grains)});
}

} // namespace

constinit const LaboratoryProtocol direct_shear = complete({
  .kind = {.name = "direct_shear",
           .title = "Direct shear",
           .strength = "shear strength",
           .sign = -1.0,
           .channel = {&CurveSample::axial_stress, "shear stress", "shear displacement over length"},
           .takes_confining_pressure = true,
           .pressure_acts_across = true,
           .strength_decimals = 2},
  .strain_rate = rate_of<ShearParameters>,
  .own_entries = {shear_entries, seating_entries},
  .forecast = {PeakForecast::With::compression, 1.1}, // granite in a box of 40 x 20 mm, examples/direct-shear
  .set_ups = {set_up_direct_shear<2>, set_up_direct_shear<3>},
});
} // namespace feldspar

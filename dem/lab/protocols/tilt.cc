#include "base/parameter_id.h"
#include "dem/lab/laboratory_run.h"
#include "dem/lab/protocols/parameters.h"
#include "dem/lab/protocols/protocols.h"
#include "dem/lab/seating.h"
#include "dem/lab/servo.h"
#include "dem/specimen/specimen_part.h"
#include "laboratory/entries.h"
#include "laboratory/own_entries.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numeric>
#include <utility>

namespace feldspar
{
namespace
{
std::vector<Entry<TestParameters>> tilt_entries()
{
  using P = TiltParameters;
  using namespace tests_flags;
  return within_tests<P>(
    {entry::quantity("Tilt rate", &P::strain_rate, Measure::rate, "1/s", {'(', 0.0, 200.0, ']'},
                     "of the angle of the plate below the body of tilt, in radians; faster, the body lags behind the "
                     "plate",
                     of_grains),
     entry::number("Tilt sampling", &P::sampling_strain, range_of_sampling_strain,
                   "tilt between two rows of the curve, in radians", of_grains)});
}

template <int dim>
SetUpTest<dim> set_up_tilt(Specimen<dim> specimen, double /*confining_pressure*/, const TestParameters& wanted,
                           const DynamicsParameters& dynamics)
{
  constexpr int axis = dim - 1;
  // A loose grain falls from one side of its void to the other while the plate tilts, for milliseconds each time. The
  // body carries its weight instead.
  const double whole = specimen.grains.volume(specimen.thickness);
  const std::vector<bool> kept = grains_of_body(specimen);
  specimen = part_of(std::move(specimen), kept);
  const double heavier = whole / specimen.grains.volume(specimen.thickness);
  for (auto* const of_grains : {&specimen.grains.mass, &specimen.grains.moment_of_inertia})
    for (double& inertia : *of_grains)
      inertia *= heavier;
  const auto own = wanted.of<TiltParameters>();
  const double height = specimen.size[axis];
  const double area = specimen.volume() / height;
  const Vector<dim> gravity = gravity_of<dim>(wanted);
  const auto& masses = specimen.grains.mass;
  const double weight = -gravity[axis] * std::accumulate(masses.begin(), masses.end(), 0.0);
  check_tilt(wanted, specimen.size[0], height);
  SetUpTest<dim> test{Dynamics<dim>(std::move(specimen), dynamics, ZeroForce::as_placed), {}};
  const std::size_t plate = stand_wall<dim>(test, {axis, 1.0, 0.0, 0.0, wanted.platen_friction}, "plate");
  test.loading.seat = [=](Dynamics<dim>& state, const std::function<void()>& check) {
    raise_pressures<dim>(
      state,
      {weight / area, wanted.seating_transits * height / wave_speed(state.specimen()),
       [&](const double share) { state.set_gravity(share * gravity); },
       [&] { return std::max(std::abs(state.wall_force(plate) / weight - 1.0), state.unbalanced_force_ratio()); },
       parameter_id<&TestParameters::gravity>(), 5e-4,
       "the body finds no rest on its lowest grains; take another seed, or a wider body"},
      check);
  };
  // The plate stays and gravity turns: the same motion, without the tiny inertia of the turning.
  test.loading.drive = [=](Dynamics<dim>& state, const SinceStart& since) {
    const double tilt = -since.axial_strain;
    state.set_gravity(std::cos(tilt) * gravity + std::sin(tilt) * gravity.norm() * Vector<dim>::Unit(0));
  };
  test.loading.strain_rate = -own.strain_rate;
  test.loading.sampling_strain = own.sampling_strain;
  // Forces between grains cancel in the sum; what is left is that of the plate.
  test.loading.end_stress = [=](const Dynamics<dim>& state) {
    const double stress = state.sum_of_forces(0) / area;
    return EndStress{stress, stress};
  };
  test.loading.servo_stress = [=](const Dynamics<dim>& state) { return -state.wall_force(plate) / area; };
  return test;
}
} // namespace

void check_tilt(const TestParameters& wanted, const double width, const double height)
{
  const auto& gravity = wanted.gravity;
  if (gravity.empty() || !(gravity.back() < 0.0) || std::ranges::count(gravity, 0.0) + 1 < std::ssize(gravity))
    throw ParameterError(
      parameter_id<&TestParameters::gravity>(),
      "the weight presses the body of tilt on its plate: give 0 and a negative last component, such as "
      "-9.81 m/s^2");
  // A body stands on its lowest grains, between which its base is narrower than the body: bodies up to width over height
  // topple before they slide.
  const double highest = 0.5 * width / height;
  if (!(wanted.platen_friction > 0.0 && wanted.platen_friction <= highest))
    throw ParameterError(
      parameter_id<&TestParameters::platen_friction>(), fmt::format("{:g}", wanted.platen_friction),
      fmt::format("must lie in (0, {:.3g}], half of width over height, for tilt: without friction the "
                  "body slides at once, with more it may topple on its lowest grains first",
                  highest));
}

constinit const LaboratoryProtocol tilt = complete({
  .kind = {.name = "tilt",
           .title = "Tilt test",
           .strength = "shear stress at sliding",
           .sign = -1.0,
           .channel = {&CurveSample::axial_stress, "shear stress on the plate", "tilt, over a radian"},
           .tilts = true,
           .strength_decimals = 6},
  .strain_rate = rate_of<TiltParameters>,
  .own_entries = {tilt_entries, platen_entries, seating_entries},
  .takes_cylinders = true,
  .takes_clumps = true,
  .set_ups = {set_up_tilt<2>, set_up_tilt<3>},
});
} // namespace feldspar

#include "dem/input_error.h"
#include "dem/lab_tests.h"
#include "dem/platens.h"
#include "dem/servo.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace feldspar
{
namespace
{
/// Walls that press on one axis.
struct WallPair
{
  int axis;
  std::size_t low;
  std::size_t high;
};

template <int dim>
double distance(const Dynamics<dim>& dynamics, const WallPair& pair)
{
  return dynamics.walls()[pair.high].position - dynamics.walls()[pair.low].position;
}
} // namespace

template <int dim>
SetUpTest<dim> set_up_triaxial_compression(const Specimen<dim>& specimen, const double confining_pressure,
                                           const TestParameters& wanted, const DynamicsParameters& dynamics)
{
  static_assert(dim == 2, "sides of a box in the plane");
  const double height = specimen.size[1];
  const double closing_speed = wanted.compression_strain_rate * height;
  const double largest_servo_speed = 20.0 * 0.5 * closing_speed;
  const double thickness = specimen.thickness;

  SetUpTest<dim> test{Dynamics<dim>(specimen, dynamics, ZeroForce::as_placed), {}};
  const auto platens = add_platens(test.dynamics, 0.0, height, wanted.platen_friction);
  const WallPair ends{1, platens.lower, platens.upper};
  const std::size_t left = test.dynamics.add_wall({0, 1.0, 0.0});
  const std::size_t right = test.dynamics.add_wall({0, -1.0, specimen.size[0]});
  const WallPair sides{0, left, right};

  const auto hold = [=](Dynamics<dim>& state, const WallPair& pair, const WallPair& across, const double pressure) {
    const double area = distance(state, across) * thickness;
    for (const std::size_t wall : {pair.low, pair.high})
      hold_pressure(state, wall, area, pressure, largest_servo_speed);
  };

  // Isotropic: all four walls press, raised over some transits of a wave so as not to hit the specimen.
  test.protocol.seat = [=](Dynamics<dim>& state) {
    const double wave_speed = std::sqrt(state.specimen().particle_contact.modulus / state.specimen().bulk_density);
    const double ramp = wanted.seating_transits * height / wave_speed;
    constexpr double tolerance = 0.005;
    constexpr double most_ramps = 20.0;
    for (;;)
      {
        const double pressure = confining_pressure * std::min(1.0, state.time() / ramp);
        hold(state, sides, ends, pressure);
        hold(state, ends, sides, pressure);
        state.step();
        if (state.time() > most_ramps * ramp)
          throw InputError(fmt::format("Tests/Confinements: the walls cannot hold {:g} MPa on this specimen",
                                       confining_pressure / 1e6));
        if (state.time() < 1.5 * ramp)
          continue;
        double worst = 0.0;
        for (const auto& [pair, across] : {std::pair(sides, ends), std::pair(ends, sides)})
          for (const std::size_t wall : {pair.low, pair.high})
            worst = std::max(
              worst,
              std::abs(state.wall_force(wall) / (distance(state, across) * thickness) / confining_pressure - 1.0));
        if (worst < tolerance)
          break;
      }
    start_steadily(state, -wanted.compression_strain_rate);
    close(state, platens, closing_speed);
  };
  test.protocol.drive = [=](Dynamics<dim>& state) { hold(state, sides, ends, confining_pressure); };

  test.protocol.strain_rate = -wanted.compression_strain_rate;
  test.protocol.sampling_strain = wanted.compression_sampling_strain;
  test.protocol.stress = [=](const Dynamics<dim>& state) {
    const double end_area = distance(state, sides) * thickness;
    const double side_area = distance(state, ends) * thickness;
    return BoundaryStress{-state.wall_force(platens.lower) / end_area, -state.wall_force(platens.upper) / end_area,
                          -0.5 * (state.wall_force(left) + state.wall_force(right)) / side_area};
  };
  return test;
}

template SetUpTest<2> set_up_triaxial_compression<2>(const Specimen<2>&, double, const TestParameters&,
                                                     const DynamicsParameters&);
} // namespace feldspar

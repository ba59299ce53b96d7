#include "dem/lab/protocols/bending.h"

#include "base/parameter_id.h"
#include "dem/lab/protocols/notch.h"
#include "dem/specimen/fragments.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <limits>

namespace feldspar
{
namespace
{
/// A smooth plate about a place along the first axis, where grains of the body lie against it, bedded, so that the body does
/// not tilt on the grain that protrudes furthest until others carry load. It pivots, so that its force acts at this
/// place. In the plane it is wide enough to meet grains on both sides; in space it is a line of grains that crosses the
/// thickness. Loose grains, which would sink into the body, do not decide where it lies.
template <int dim>
Wall roller(const Specimen<dim>& body, const std::vector<bool>& is_loose, const double place, const double side)
{
  constexpr int axis = dim - 1;
  const double mean_radius = body.report.mean_radius;
  const double half_width = (dim == 2 ? 2.0 : 1.0) * mean_radius;
  // The surfaces that protrude furthest before the middle and beyond it, along `side`.
  std::array<double, 2> nearest;
  nearest.fill(std::numeric_limits<double>::infinity());
  for (std::size_t i = 0; i < body.grains.size(); ++i)
    if (const double lever = body.grains.position[0][i] - place; !is_loose[i] && std::abs(lever) <= half_width)
      {
        const double surface = side * body.grains.position[axis][i] - body.grains.radius[i];
        double& nearest_there = nearest[lever < 0.0 ? 0 : 1];
        nearest_there = std::min(nearest_there, surface);
      }
  const auto [closer, farther] = std::minmax(nearest[0], nearest[1]);
  if (!std::isfinite(farther))
    throw ParameterError(parameter_id<&SpecimenParameters::width>(),
                         fmt::format("the roller at {:.3g} mm has no bonded grain on one side of its middle; make the "
                                     "specimen larger or the grains smaller ({})",
                                     1e3 * place, in_words(parameter_id<&SpecimenParameters::minimum_radius>())));
  // Deep enough for a grain on either side, on whose surface the bed does not end by rounding.
  constexpr double clearance = 1.01;
  Wall plate{.axis = axis,
             .side = side,
             .position = side * closer,
             .pivots = true,
             .bed = std::max(mean_radius, clearance * (farther - closer))};
  plate.extent = {place - half_width, place + half_width};
  return plate;
}
} // namespace

std::vector<Entry<TestParameters>> bending_entries()
{
  using P = BendingParameters;
  using namespace tests_flags;
  return within_tests<P>(
    {entry::quantity("Bending strain rate", &P::strain_rate, Measure::rate, "1/s", ranges::above_zero,
                     "of the deflection over the depth of the bent body; magnitude", of_grains),
     entry::number("Bending sampling strain", &P::sampling_strain, range_of_sampling_strain,
                   "deflection over depth between two rows of the curve", of_grains)});
}

/// Gives the grains the velocities of a beam that bends steadily [m/s]: set off from rest, it would swing, and its first
/// swing would pass for a peak.
template <int dim>
void start_bending(Dynamics<dim>& dynamics, const double span, const double speed)
{
  const auto& grains = dynamics.specimen().grains;
  const double middle = 0.5 * dynamics.specimen().size[0];
  for (std::uint32_t i = 0; i < grains.size(); ++i)
    {
      // The motion from the lower roller over half the span is the deflection of a simple beam under a load in its
      // middle; straight beyond the roller.
      const double s = 1.0 - std::abs(grains.position[0][i] - middle) / (0.5 * span);
      const double share = s > 0.0 ? 0.5 * s * (3.0 - s * s) : 1.5 * s;
      dynamics.push(i, -share * speed * Vector<dim>::Unit(dim - 1));
    }
}

template <int dim>
SetUpTest<dim> bend(Specimen<dim> body, const Bending& bending, const TestParameters& wanted,
                    const DynamicsParameters& dynamics)
{
  const auto& own = wanted.of<BendingParameters>();
  const double a = wanted.of<NotchParameters>().ratio;
  const double middle = 0.5 * body.size[0];
  cut_notch(body, {middle, 0.0}, {middle, a * bending.depth}, wanted);

  const std::vector<bool> is_loose = loose_grains(body);
  Wall upper = roller(body, is_loose, middle, -1.0);
  upper.velocity = -own.strain_rate * bending.depth;
  const std::array<Wall, 2> lower{roller(body, is_loose, middle - 0.5 * bending.span, 1.0),
                                  roller(body, is_loose, middle + 0.5 * bending.span, 1.0)};
  SetUpTest<dim> test{Dynamics<dim>(std::move(body), dynamics, ZeroForce::as_placed), {}};
  start_bending(test.dynamics, bending.span, own.strain_rate * bending.depth);
  const std::size_t left = test.dynamics.add_wall(lower[0]);
  const std::size_t right = test.dynamics.add_wall(lower[1]);
  const std::size_t top = test.dynamics.add_wall(upper);

  test.loading.strain_rate = -own.strain_rate;
  test.loading.sampling_strain = own.sampling_strain;
  test.loading.notch = {.intensity_over_stress = bending.intensity_over_stress,
                        .work_over_stress = bending.depth / bending.stress_over_force,
                        .ligament_area = bending.breadth * bending.depth * (1.0 - a),
                        .ligament_length = bending.depth * (1.0 - a),
                        .is_valid = bending.is_valid};
  test.loading.end_stress = [=, factor = bending.stress_over_force](const Dynamics<dim>& state) {
    return EndStress{-factor * (state.wall_force(left) + state.wall_force(right)), -factor * state.wall_force(top)};
  };
  return test;
}

template SetUpTest<2> bend<2>(Specimen<2>, const Bending&, const TestParameters&, const DynamicsParameters&);
template SetUpTest<3> bend<3>(Specimen<3>, const Bending&, const TestParameters&, const DynamicsParameters&);
} // namespace feldspar

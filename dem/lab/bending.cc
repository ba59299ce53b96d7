#include "dem/lab/bending.h"

#include "base/input_error.h"
#include "dem/lab/notch.h"

#include <fmt/format.h>

#include <array>
#include <cmath>
#include <cstdint>
#include <limits>

namespace feldspar
{
namespace
{
/// A smooth plate about a place along the first axis, where grains of the body lie against it. In the plane it is wide
/// enough to meet a grain and bears the one that stands out most. In space it is a line of grains that crosses the
/// thickness, bedded: on the one that stands out most the body would tilt until others bear.
template <int dim>
Wall roller(const Specimen<dim>& body, const double place, const double side)
{
  constexpr int axis = dim - 1;
  const double mean_radius = body.report.mean_radius;
  const double half_width = dim == 2 ? 2.0 * mean_radius : mean_radius;
  Wall plate{.axis = axis,
             .side = side,
             .position = side * std::numeric_limits<double>::infinity(),
             .bed = dim == 2 ? 0.0 : mean_radius};
  plate.extent = {place - half_width, place + half_width};
  for (std::size_t i = 0; i < body.grains.size(); ++i)
    if (const double x = body.grains.position[0][i]; x >= plate.extent[0] && x <= plate.extent[1])
      {
        const double surface = body.grains.position[axis][i] - side * body.grains.radius[i];
        if (side * surface < side * plate.position)
          plate.position = surface;
      }
  if (!std::isfinite(plate.position))
    throw InputError(
      fmt::format("Specimen/Width: no grain lies at the roller at {:.3g} mm; make the specimen larger or "
                  "the grains smaller (Specimen/Minimum radius)",
                  1e3 * place));
  return plate;
}
} // namespace

/// Gives the grains the velocities of a beam that bends steadily [m/s]: set off from rest, it would swing, and its first
/// swing would pass for a peak.
template <int dim>
void start_bending(Dynamics<dim>& dynamics, const double span, const double speed)
{
  const auto& grains = dynamics.specimen().grains;
  const double middle = 0.5 * dynamics.specimen().size[0];
  for (std::uint32_t i = 0; i < grains.size(); ++i)
    {
      // From the lower roller over half the span: the deflection of a simple beam under a load in its middle; straight
      // beyond the roller.
      const double s = 1.0 - std::abs(grains.position[0][i] - middle) / (0.5 * span);
      const double share = s > 0.0 ? 0.5 * s * (3.0 - s * s) : 1.5 * s;
      dynamics.push(i, -share * speed * Vector<dim>::Unit(dim - 1));
    }
}

template <int dim>
SetUpTest<dim> bend(Specimen<dim> body, const Bending& bending, const TestParameters& wanted,
                    const DynamicsParameters& dynamics)
{
  const double middle = 0.5 * body.size[0];
  cut_notch(body, {middle, 0.0}, {middle, bending.notch_depth}, wanted);

  Wall upper = roller(body, middle, -1.0);
  upper.velocity = -wanted.bending_strain_rate * bending.depth;
  const std::array<Wall, 2> lower{roller(body, middle - 0.5 * bending.span, 1.0),
                                  roller(body, middle + 0.5 * bending.span, 1.0)};
  SetUpTest<dim> test{Dynamics<dim>(std::move(body), dynamics, ZeroForce::as_placed), {}};
  start_bending(test.dynamics, bending.span, wanted.bending_strain_rate * bending.depth);
  const std::size_t left = test.dynamics.add_wall(lower[0]);
  const std::size_t right = test.dynamics.add_wall(lower[1]);
  const std::size_t top = test.dynamics.add_wall(upper);

  test.loading.strain_rate = -wanted.bending_strain_rate;
  test.loading.sampling_strain = wanted.bending_sampling_strain;
  test.loading.notch = bending.notch;
  test.loading.end_stress = [=, factor = bending.stress_over_force](const Dynamics<dim>& state) {
    return EndStress{-factor * (state.wall_force(left) + state.wall_force(right)), -factor * state.wall_force(top)};
  };
  return test;
}

template SetUpTest<2> bend<2>(Specimen<2>, const Bending&, const TestParameters&, const DynamicsParameters&);
template SetUpTest<3> bend<3>(Specimen<3>, const Bending&, const TestParameters&, const DynamicsParameters&);
} // namespace feldspar

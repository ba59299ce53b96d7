#include "dem/dynamics/runaway.h"

#include "base/parameter_id.h"
#include "dem/dynamics/parameters.h"

#include <fmt/format.h>

#include <cmath>

namespace feldspar
{
namespace
{
// A fragment that is thrown out flies freely, some thousand diameters of the body in the slowest of tests.
constexpr double reach_over_size = 1e6;

std::string likely_reason(const Circumstances& now)
{
  // Quasi-static loading goes a millionth of a radius in a step.
  constexpr double hasty = 1e-2;
  // Ratio below which a step is stable whatever the contacts do.
  constexpr double near_the_edge = 0.95;
  if (const double way = now.loading_speed * now.dt / now.smallest_radius; way > hasty)
    return fmt::format("the loading goes {:.2g} radii of the smallest grain in a step; a lower rate would help", way);
  if (now.through_wall)
    return "the contacts of its grains are too soft for this load; a higher modulus of contacts and joints would help";
  if (now.share_of_stable_step > near_the_edge)
    return fmt::format("the time step is {:.3g} times the root of mass over stiffness; a smaller {} would help",
                       now.share_of_stable_step, in_words(parameter_id<&DynamicsParameters::time_step_safety>()));
  return fmt::format("forces have outgrown its contacts; a smaller {}, more {} or a lower rate may help",
                     in_words(parameter_id<&DynamicsParameters::time_step_safety>()),
                     entry_in_words(parameter_id<&DynamicsParameters::damping>()));
}
} // namespace

template <int dim>
std::optional<StrayGrain> find_stray_grain(const Specimen<dim>& body, const GrainRange& own, const Walls<dim>& walls,
                                           const double dt)
{
  const auto& grains = body.grains;
  const Vector<dim> middle = 0.5 * body.size;
  const double reach = reach_over_size * body.size.maxCoeff();
  // Written so that a comparison with what is no number tells it.
  const auto is_near = [&](const std::size_t i) {
    return (at<dim>(grains.position, i) - middle).squaredNorm() <= reach * reach;
  };
  const auto moves = [&](const std::size_t i) { return dt * dt * squared_norm<dim>(grains.velocity, i); };
  const auto rolls = [&](const std::size_t i) {
    return dt * dt * grains.radius[i] * grains.radius[i] * squared_norm<n_rotations<dim>>(grains.spin, i);
  };
  const auto is_slow = [&](const std::size_t i) { return moves(i) + rolls(i) <= grains.radius[i] * grains.radius[i]; };
  std::size_t n_objections = 0; // counted without branches: nearly always there are none
  for (std::size_t i = own.first; i < own.end; ++i)
    n_objections += std::size_t(!is_near(i)) + std::size_t(!is_slow(i));
  for (std::uint32_t i = own.first; i < own.end && n_objections > 0; ++i)
    {
      if (!is_near(i))
        return StrayGrain{i};
      if (!is_slow(i))
        return StrayGrain{i, false, std::sqrt(moves(i) + rolls(i)) / grains.radius[i]};
    }

  std::optional<StrayGrain> beyond_wall;
  walls.for_each_touch([&](const Wall&, const WallTouch<dim>& touch) {
    // The overlap decides, not the position of the centre: a cut specimen may begin with a centre just inside the wall.
    if (!beyond_wall && touch.overlap > body.grains.radius[touch.grain])
      beyond_wall = StrayGrain{touch.grain, true};
  });
  return beyond_wall;
}

std::string StrayGrain::motion() const
{
  if (through_wall)
    return "has been pressed through a wall";
  return way_over_radius == 0.0 ? "stands nowhere near the body"
                                : fmt::format("goes {:.3g} of its radii", way_over_radius);
}

std::string describe_runaway(const std::string& trouble, const Circumstances& circumstances)
{
  return fmt::format("numbers went wrong: {} in step {}; {}", trouble, circumstances.step,
                     likely_reason(circumstances));
}

template std::optional<StrayGrain> find_stray_grain<2>(const Specimen<2>&, const GrainRange&, const Walls<2>&, double);
template std::optional<StrayGrain> find_stray_grain<3>(const Specimen<3>&, const GrainRange&, const Walls<3>&, double);
} // namespace feldspar

#include "dem/dynamics/contact_watch.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace feldspar
{
namespace
{
constexpr std::uint64_t most_steps_between_checks = 10; // for grains that have come near each other
constexpr double skin_over_smallest_radius = 0.3;
constexpr double wall_reach_over_skin = 0.25; // as near as a wall may come to a grain that is not in its list
} // namespace

template <int dim>
ContactWatch<dim>::ContactWatch(const Grains<dim>& grains)
  : widest_gap(skin_over_smallest_radius * *std::ranges::min_element(grains.radius))
{
}

template <int dim>
bool ContactWatch<dim>::may_miss_contacts(const Specimen<dim>& body, const BodyShare<dim>& share,
                                          const Walls<dim>& walls, const std::uint64_t step, const double dt)
{
  double farthest = 0.0;
  double fastest = 0.0;
  const GrainRange own = share.grains();
  for (std::size_t i = own.first; i < own.end; ++i)
    {
      farthest = std::max(farthest, (at<dim>(body.grains.position, i) - at<dim>(position_at_search, i)).squaredNorm());
      fastest = std::max(fastest, squared_norm<dim>(body.grains.velocity, i));
    }
  const std::vector<double> of_all = share.largest({farthest, fastest});
  farthest = of_all[0];
  fastest = of_all[1];
  // Twice the way of the fastest, for what accelerates meanwhile; half the skin, for both grains move.
  const double way_of_a_step = 2.0 * dt * std::sqrt(fastest);
  const double way_left = 0.5 * widest_gap - std::sqrt(farthest);
  bool missed = way_left <= double(most_steps_between_checks) * way_of_a_step;
  double steps_allowed = 0.5 * widest_gap / std::max(way_of_a_step, std::numeric_limits<double>::min());
  // Grains keep to half the skin, so that a wall must have gone the rest of it to be near one that is not listed. One
  // that pushes grains before it finds none: the grains' own way has brought on a search before.
  const double reach = wall_reach_over_skin * widest_gap;
  for (std::size_t w = 0; w < walls.size(); ++w)
    if (const Wall& wall = walls[w]; wall.velocity != 0.0 || wall.pivots)
      {
        steps_allowed = std::min(steps_allowed, reach / (way_of_a_step + 2.0 * dt * std::abs(wall.velocity)));
        if (walls.way_since_search(w) > 0.5 * widest_gap - reach)
          missed = missed || walls.smallest_gap_not_listed(body, own, w) < reach;
      }
  missed = share.any(missed);
  next_check = step + std::uint64_t(std::clamp(steps_allowed, 1.0, double(most_steps_between_checks)));
  return missed;
}

template class ContactWatch<2>;
template class ContactWatch<3>;
} // namespace feldspar

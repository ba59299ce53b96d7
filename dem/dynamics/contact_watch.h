#pragma once

#include "dem/dynamics/walls.h"
#include "dem/sharing/body_share.h"
#include "dem/specimen/specimen.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <vector>

namespace feldspar
{
/// Watches how far grains and walls have gone since contacts were last searched for, so that none is missed and few steps
/// look.
template <int dim>
class ContactWatch
{
public:
  explicit ContactWatch(const Grains<dim>& grains)
    : widest_gap(skin_over_smallest_radius * *std::ranges::min_element(grains.radius))
  {
  }

  /// Gap up to which contacts are kept in mind [m].
  double skin() const { return widest_gap; }

  void note_search(const Grains<dim>& grains) { position_at_search = grains.position; }
  /// The next look is due after the step.
  void begin_at(const std::uint64_t step) { next_check = step + 1; }
  bool is_due(const std::uint64_t step) const { return step == next_check; }

  /// Returns whether a pair that was not near at the last search could come into contact before the next check; sets
  /// the time of that check.
  bool may_miss_contacts(const Specimen<dim>& body, const BodyShare<dim>& share, const Walls<dim>& walls,
                         const std::uint64_t step, const double dt)
  {
    double farthest = 0.0;
    double fastest = 0.0;
    const GrainRange own = share.grains();
    for (std::size_t i = own.first; i < own.end; ++i)
      {
        farthest =
          std::max(farthest, (at<dim>(body.grains.position, i) - at<dim>(position_at_search, i)).squaredNorm());
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

  template <typename Archive>
  void transfer(Archive& archive)
  {
    transfer_components(archive, "position_at_search", position_at_search);
    archive.value("next_look", next_check);
  }

private:
  static constexpr std::uint64_t most_steps_between_checks = 10; // for grains that have come near each other
  static constexpr double skin_over_smallest_radius = 0.3;
  static constexpr double wall_reach_over_skin = 0.25; // as near as a wall may come to a grain that is not in its list

  double widest_gap;
  Components<dim> position_at_search;
  std::uint64_t next_check = 0; ///< step before which no contact can have been missed
};
} // namespace feldspar

#pragma once

#include "dem/dynamics/dynamics.h"
#include "dem/lab/cracks.h"
#include "dem/lab/emission_entries.h"
#include "laboratory/record.h"

#include <array>
#include <cstdint>
#include <vector>

namespace feldspar
{
/// Gathers the breaks of a test into events of acoustic emission, and measures the moment tensor of each while it lasts:
/// M = Σ sym(f ⊗ d) over its broken segments, with d the branch from grain 1 to grain 2 and f the force on grain 2 less that
/// which the segment would exert if it still held. These pairs of forces bring the body with whole joints to the same
/// displacements (Backus and Mulcahy 1976); docs/theory.md §4.14.
template <int dim>
class EmissionWatch
{
public:
  EmissionWatch(const Specimen<dim>& body, const EmissionParameters& wanted);

  /// Gives the cracks of a step, which are the last of all, their events, and measures the events that last. Called after
  /// each step.
  void follow(const Dynamics<dim>& dynamics, const std::vector<CrackBetween>& of_step, std::vector<Crack>& all);

  /// The events of these cracks, in the order of their first breaks; the cracks get the numbers of the list, from 1.
  /// `start`: the time of zero strain [s].
  std::vector<EmissionEvent> catalogue(std::vector<Crack>& cracks, double start) const;

  template <typename Archive>
  void transfer(Archive& archive);

private:
  using Moment = std::array<double, std::size_t(dim) * dim>;

  struct Event
  {
    double time;           ///< of the first break [s]
    std::uint64_t part_of; ///< the event that took it over; itself otherwise
    Moment moment;         ///< when its scalar moment was largest [N m]
  };

  struct BrokenSegment
  {
    std::uint32_t grain_1, grain_2, joint, segment; ///< the joint by its number
    std::uint64_t on_smooth_joint; ///< 1 or 0; as wide, so that no bit of a checkpoint is left to chance
    std::array<double, dim> place; ///< at the break [m]
    Moment moment;                 ///< as long as its joint is there [N m]
  };

  /// A running event and its broken segments, which lie in a ball about the mean of their places. Their distances from it all
  /// change with each break. To measure all of them each time would take too long: bounds of the largest decide most cases.
  struct Source
  {
    std::uint64_t event = 0;
    double end = 0.0; ///< time, unless it grows [s]
    bool has_grown = false;
    Vector<dim> sum_of_places = Vector<dim>::Zero(); ///< in the order of the breaks [m]
    std::array<double, 2> farthest{};                ///< distance of a break from the centre, at least and at most [m]
    std::vector<BrokenSegment> broken{};

    Vector<dim> centre() const { return sum_of_places / double(broken.size()); }
    void add(const BrokenSegment& one);
    /// Measures how far the farthest break is.
    void measure_extent();
    /// Returns whether a place is no farther than `more` [m] from the ball.
    bool is_near(const Vector<dim>& place, double more);
  };

  static void keep_larger(Moment& moment, const Moment& other);
  Source& source_at(const Vector<dim>& place, double time);
  static void measure(const Dynamics<dim>& dynamics, const std::vector<BrokenSegment*>& segments);
  void measure(const Dynamics<dim>& dynamics, const std::vector<Source*>& those);
  static Moment sum_of(const Source& source);

  double least_radius;          ///< [m]
  double duration_over_radius;  ///< [s/m]
  double thickness_ratio = 1.0; ///< of the body in the laboratory to that in the plane
  std::vector<Event> events;
  std::vector<Source> sources; ///< by event
};
} // namespace feldspar

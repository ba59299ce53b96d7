#pragma once

#include "dem/dynamics/energy_ledger.h"
#include "dem/dynamics/images.h"
#include "dem/dynamics/incidence.h"
#include "dem/dynamics/parameters.h"
#include "dem/laws/contact_motion.h"
#include "dem/laws/linear_contact_law.h"
#include "dem/sharing/body_share.h"
#include "dem/specimen/neighbours.h"
#include "dem/specimen/specimen.h"

#include <array>
#include <cstdint>
#include <functional>
#include <limits>
#include <span>
#include <utility>
#include <vector>

namespace feldspar
{
/// Two grains near each other and without a face.
struct NearPair
{
  std::uint32_t grain_1, grain_2;
  double zero_distance; ///< centre distance below which they press [m]

  GrainPair ends() const { return {grain_1, grain_2}; }
};

/// The contact of a pair, which most of those near each other never make.
template <int dim>
struct Touch
{
  std::uint32_t grain_1, grain_2;
  linear_contact::Stiffness<double> stiffness;
  double half_radius_difference; ///< [m]
  bool touching = false;
  ContactFrame<dim, double> frame{}; ///< at the last step in which they were in contact
  std::array<double, dim - 1> shear_force{};
  double normal_force = 0.0;
  double slip_energy = 0.0;
  ContactForce<dim, double> on_grains{};

  GrainPair ends() const { return {grain_1, grain_2}; }
};

/// The contact of two grains of a body that have not been in contact yet.
template <int dim>
Touch<dim> make_touch(const Specimen<dim>& body, std::uint32_t grain_1, std::uint32_t grain_2);

/// The pair of two grains that press from the distance at which their surfaces meet.
template <int dim>
NearPair near_pair(const Specimen<dim>& body, std::uint32_t grain_1, std::uint32_t grain_2);

/// All pairs of grains near each other and without a face, by their grains.
template <int dim>
class Touches
{
public:
  std::size_t size() const { return pairs.size(); }
  /// Pairs in which each grain takes part.
  const Incidence& incidence() const { return pairs_of; }
  /// Returns whether the pair of this number presses.
  bool is_touching(const std::size_t pair) const { return pairs[pair].touching; }
  /// The contact of a pair that presses.
  const Touch<dim>& touch(const std::size_t pair) const { return touches[pairs[pair].touch]; }
  /// The grain that feels what grain 2 of one does: itself, or the grain that it is an image of.
  std::uint32_t owner_2(const std::size_t pair) const { return pairs[pair].owner_2; }
  /// Numbers of the pairs that were in contact at the last update(), ascending; none from number() to the next one.
  std::span<const std::uint32_t> touching() const { return std::span(touching_ones).first(n_touching); }
  /// visit(contact) for each pair that has been in contact, by its grains.
  template <typename Visit>
  void for_each_touch(const Visit& visit) const
  {
    for (const Near& pair : pairs)
      if (pair.touch != none)
        visit(touches[pair.touch]);
  }

  /// Notes the pairs within `skin` [m] that concern this process; those with a face are told by the joints. `check` as of
  /// pairs_within().
  void search(const Specimen<dim>& body, const Images<dim>& images, const BodyShare<dim>& share,
              const Incidence& joints_of, double skin, ZeroForce zero_force, EnergyLedger& ledger,
              const std::function<void()>& check);
  /// A pair that has lost its face; number() before the next update().
  void add(const NearPair& pair);
  /// All pairs, and what those that have been in contact store; both by their grains.
  std::vector<NearPair> near_pairs() const { return {pairs.begin(), pairs.end()}; }
  std::vector<Touch<dim>> in_order() const;
  /// Takes these for all there are; number() before the next update().
  void take(const std::vector<NearPair>& near, std::vector<Touch<dim>> stored);
  void number(const Images<dim>& images);
  void clear() { *this = {}; }

  /// Carries all over a step [s]; returns whether a pair has come into contact. No grain or image may have gone farther
  /// than `farthest_way` [m] since the last update() or number(); infinite where that is not known.
  bool update(const Specimen<dim>& body, double dt, double farthest_way);

  /// Adds what the contacts store and have dissipated.
  void add_energies(EnergySums& sums, const BodyShare<dim>& share) const;

private:
  static constexpr std::uint32_t none = std::numeric_limits<std::uint32_t>::max();

  /// A pair, by which a step finds out whether it is in contact. Most are not; therefore these data are small.
  struct Near : NearPair
  {
    std::uint32_t owner_2;
    std::uint32_t touch; ///< its number, or none
    bool touching;
  };

  auto find(const GrainPair& pair) const;
  void forget_ways();

  std::vector<Near> pairs;
  std::vector<Touch<dim>> touches;
  double way_gone = 0.0;           ///< by a grain at most, since number() [m]
  std::vector<double> apart_until; ///< way_gone up to which the grains of each pair cannot meet [m]
  std::size_t n_updates = 0;       ///< in which way_gone has grown
  bool touching_ones_are_known = false;
  std::vector<std::uint32_t> touching_ones; ///< the first n_touching hold
  std::size_t n_touching = 0;
  Incidence pairs_of;
};
} // namespace feldspar

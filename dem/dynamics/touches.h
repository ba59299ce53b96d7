#pragma once

#include "dem/dynamics/energy_ledger.h"
#include "dem/dynamics/images.h"
#include "dem/dynamics/incidence.h"
#include "dem/dynamics/zero_force.h"
#include "dem/laws/contact_motion.h"
#include "dem/laws/linear_contact_law.h"
#include "dem/sharing/body_share.h"
#include "dem/specimen/neighbours.h"
#include "dem/specimen/specimen.h"

#include <array>
#include <cstdint>
#include <functional>
#include <span>
#include <utility>
#include <vector>

namespace feldspar
{
/// Two grains near each other and without a face.
template <int dim>
struct Touch
{
  std::uint32_t grain_1, grain_2;
  linear_contact::Stiffness<double> stiffness;
  double zero_distance;          ///< centre distance below which they press [m]
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

/// All pairs of grains near each other and without a face, by their grains.
template <int dim>
class Touches
{
public:
  const std::vector<Touch<dim>>& list() const { return touches; }
  /// Contacts in which each grain takes part.
  const Incidence& incidence() const { return contacts_of; }
  /// Returns whether the contact of this number presses; does not read the Touch itself.
  bool is_touching(const std::size_t touch) const { return looks[touch].touching; }
  /// The grain that feels what grain 2 of one does: itself, or the grain that it is an image of.
  std::uint32_t owner_2(const std::size_t touch) const { return looks[touch].owner_2; }
  /// Numbers of the contacts that were closed at the last update(), ascending; none from number() to the next one.
  std::span<const std::uint32_t> touching() const { return std::span(touching_ones).first(n_touching); }

  /// Notes the pairs within `skin` [m] that concern this process; those with a face are told by the joints. `check` as of
  /// pairs_within().
  void search(const Specimen<dim>& body, const Images<dim>& images, const BodyShare<dim>& share,
              const Incidence& joints_of, double skin, ZeroForce zero_force, EnergyLedger& ledger,
              const std::function<void()>& check);
  /// Takes these, sorted by their grains, for all there are; number() before the next update().
  void take(std::vector<Touch<dim>> all) { touches = std::move(all); }
  /// A pair that has lost its face; number() before the next update().
  void add(const Touch<dim>& touch);
  void number(const Images<dim>& images);
  void clear() { *this = {}; }

  /// Carries all over a step [s]; returns whether a pair has come into contact. No grain or image may have gone farther
  /// than `farthest_way` [m] since the last update() or number(); infinite where that is not known.
  bool update(const Grains<dim>& grains, double friction, double dt, double farthest_way);

  /// Adds what the contacts store and have dissipated.
  void add_energies(EnergySums& sums, const BodyShare<dim>& share) const;

private:
  /// Data by which a step finds out whether a pair has come into contact. Most pairs have not; therefore these data are
  /// small and kept together, while a Touch takes several lines of the cache.
  struct Look
  {
    std::uint32_t grain_1, grain_2;
    double zero_distance;
    std::uint32_t owner_2;
    bool touching;
  };

  auto find(const GrainPair& pair) const;
  void forget_ways();

  std::vector<Touch<dim>> touches;
  std::vector<Look> looks;         ///< of each contact
  double way_gone = 0.0;           ///< by a grain at most, since number() [m]
  std::vector<double> apart_until; ///< way_gone up to which the grains of each contact cannot meet [m]
  std::size_t n_updates = 0;       ///< in which way_gone has grown
  bool touching_ones_are_known = false;
  std::vector<std::uint32_t> touching_ones; ///< the first n_touching hold
  std::size_t n_touching = 0;
  Incidence contacts_of;
};
} // namespace feldspar

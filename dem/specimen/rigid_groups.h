#pragma once

#include "dem/specimen/specimen.h"

#include <cstdint>
#include <vector>

/// Grains that move as one rigid body: the groups of a specimen of clumps, in the plane; docs/theory.md §2.6.
namespace feldspar
{
/// Position of the body that each grain is a part of: the centre of its group, or its own centre.
template <int dim>
class BodyCentres
{
public:
  explicit BodyCentres(const Specimen<dim>& specimen)
    : BodyCentres(specimen, specimen.grains.position)
  {
  }
  /// The centres for grains that stand at these positions, which must outlive it [m].
  BodyCentres(const Specimen<dim>& specimen, const Components<dim>& positions);
  BodyCentres(const BodyCentres&) = delete;
  BodyCentres& operator=(const BodyCentres&) = delete;

  /// The centre of each grain's body [m]; [n_grains].
  const Components<dim>& all() const { return *centre; }
  /// The centre of one grain's body [m].
  Vector<dim> of(const std::uint32_t grain) const { return at<dim>(*centre, grain); }

private:
  Components<dim> own;
  const Components<dim>* centre;
};

/// The groups of a specimen as bodies of their own; empty where grains move each for itself. A group has the mass of its
/// members, Σm, their centre and the moment of inertia Σ(I + m d²) about it, with d from that centre.
template <int dim>
class RigidGroups
{
public:
  /// Takes the members where they stand, at rest.
  explicit RigidGroups(const Specimen<dim>& specimen);

  bool empty() const { return of.empty(); }
  std::size_t size() const { return bodies.size(); }
  /// The group that a grain is a part of.
  std::uint32_t body_of(const std::uint32_t grain) const { return of[grain]; }

  /// Bodies move as grains do: mass, motion, forces. Their radii are those of discs of their volumes.
  Grains<dim> bodies;

  /// An impulse m Δv at the centre of a member [m/s]: pushes its group and turns it.
  void push(Grains<dim>& grains, std::uint32_t grain, const Vector<dim>& velocity);
  /// Forces and couples of the groups from those of their members, in the order of these.
  void gather(const Grains<dim>& grains);
  /// After the groups have moved by a step [s]: turns them, and their members go along. These have the velocity of their
  /// way and the spin of their group.
  void carry_members(Grains<dim>& grains, double dt);

  template <typename Archive>
  void transfer(Archive& archive)
  {
    if (empty())
      return;
    transfer_components(archive, "group_position", bodies.position);
    transfer_components(archive, "group_velocity", bodies.velocity);
    transfer_components(archive, "group_spin", bodies.spin);
    transfer_components(archive, "group_force", bodies.force);
    transfer_components(archive, "group_couple", bodies.couple);
    archive.array("group_angle", angle);
  }

private:
  std::vector<std::uint32_t> of;      ///< group of each grain
  std::vector<std::uint32_t> first;   ///< of each group's among the members; [n_groups + 1]
  std::vector<std::uint32_t> members; ///< by group, ascending
  Components<dim> arm;                ///< of each grain from the centre of its group, before it turned [m]
  std::vector<double> angle;          ///< by which each group has turned
};
} // namespace feldspar

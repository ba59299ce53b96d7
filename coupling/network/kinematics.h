#pragma once

#include "coupling/network/link.h"

/// How the motion of a link follows from those of its grains; docs/theory.md §9.8.
namespace feldspar
{
enum class Kinematics
{
  small_strains, ///< normals, branches and contact points stay at the reference
  finite         ///< normals and branches follow the grains
};

/// A link whose branch has turned and stretched with its grains.
template <int dim>
struct TurnedLink
{
  Motion<dim> motion; ///< since rest [m, rad]
  /// Of its displacement components, by the way of the second centre from the first in the axes at rest.
  Tensor<dim> gradient;
};

/// Where the grains stand. The displacement along n is the growth of the distance of the centres; the slip is the angle by
/// which the branch has turned, times its length at rest, less the turns of the grains times their arms. In the plane a
/// rigid rotation of both grains is no motion; in space it is one of second order in the rotation.
template <int dim>
TurnedLink<dim> turned(const Link<dim>& link, const Unknowns& position);

/// What the forces of a link add to its stiffness because they turn with the branch, by the same way [N/m]. Symmetric; in
/// space to first order in the angle of the branch.
template <int dim>
Tensor<dim> turning_stiffness(const Link<dim>& link, const Unknowns& position, const Motion<dim>& forces);

/// How the forces of a link that stands turned reach its grains, and how stiff it is beyond its law.
template <int dim>
struct LinkTurn
{
  Tensor<dim> gradient = Tensor<dim>::Identity();
  Tensor<dim> stiffness = Tensor<dim>::Zero(); ///< turning_stiffness() [N/m]
};

/// Small motion of a turned link.
template <int dim>
Motion<dim> link_motion(const Link<dim>& link, const Tensor<dim>& gradient, const Unknowns& unknowns);

/// Adds what the forces of a turned link do: the transpose.
template <int dim>
void add_forces(const Link<dim>& link, const Tensor<dim>& gradient, const Motion<dim>& forces, Unknowns& sum);

/// Adds what a stiffness against the way of the second centre from the first does.
template <int dim>
void add_turning_forces(const Link<dim>& link, const Tensor<dim>& stiffness, const Unknowns& unknowns, Unknowns& sum);
} // namespace feldspar

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

/// A link whose branch has turned and stretched with its grains. The displacement along n is the growth of the distance
/// of the centres; the slip is the angle by which the branch has turned, times its length at rest, less the turns of the
/// grains times their arms. In the plane a rigid rotation of both grains is no motion. In space it is a false slip of half
/// the product of its twist and its tilt.
template <int dim>
class TurnedLink
{
public:
  /// Where the grains stand at a position.
  TurnedLink(const Link<dim>& link, const Unknowns& position);

  /// Since rest [m, rad].
  const Motion<dim>& motion() const { return its_motion; }

  /// Of the displacement components of the motion, by the way of the second centre from the first in the axes at rest.
  Tensor<dim> gradient() const;

  /// What forces of the link, conjugate to its motion, add to its stiffness against the same way because they turn with the
  /// branch [N/m]. Symmetric; to first order in the angle of the branch.
  Tensor<dim> stiffness(const Motion<dim>& forces) const;

private:
  double length_at_rest;
  Vector<dim> end; ///< of the branch, in the axes at rest [m]
  double length;
  double slope;        ///< the angle of the branch over its way across the normal at rest, ψ/ρ [1/m]
  double slope_change; ///< (d(ψ/ρ)/dρ)/ρ [1/m³]
  Motion<dim> its_motion;
};

/// How the forces of a link that stands turned reach its grains, and how stiff it is beyond its law.
template <int dim>
struct LinkTurn
{
  Tensor<dim> gradient = Tensor<dim>::Identity();
  Tensor<dim> stiffness = Tensor<dim>::Zero(); ///< TurnedLink::stiffness() [N/m]
};

/// Small motion of a turned link.
template <int dim>
Motion<dim> link_motion(const Link<dim>& link, const Tensor<dim>& gradient, const Unknowns& unknowns);

/// Adds what the forces of a turned link do: the transpose.
template <int dim>
void add_forces(const Link<dim>& link, const Tensor<dim>& gradient, const Motion<dim>& forces, Unknowns& sum);

/// Adds the forces that a small motion makes, or several do, by the stiffness of the link and that of its turning.
template <int dim, typename Columns>
void add_forces_of_motion(const Link<dim>& link, const LinkTurn<dim>& turn, const JointStiffness<dim>& stiffness,
                          const Columns& motion, Columns& sum);
} // namespace feldspar

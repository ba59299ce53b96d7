#pragma once

#include "coupling/network/link.h"

#include <type_traits>
#include <variant>

/// Motion of a link as it follows from the motions of its grains; docs/theory.md §9.8.
namespace feldspar
{
enum class Kinematics
{
  small_strains, ///< normals, branches and contact points stay at the reference
  finite         ///< normals and branches follow the grains
};

/// The turns of both grains of a link in space, or changes of them, in its own axes at rest [rad].
template <typename Columns>
struct OwnTurns
{
  RowsOf<3, Columns> of_1 = RowsOf<3, Columns>::Zero(), of_2 = RowsOf<3, Columns>::Zero();
};

/// Turns in the plane are about one axis: nothing depends on how far they have gone.
template <int dim>
using LinkTurns = std::conditional_t<dim == 3, OwnTurns<Unknowns>, std::monostate>;

/// Gradient of a small motion of a turned link by the motions of its grains.
template <int dim>
struct TurnedGradient
{
  Tensor<dim> by_way = Tensor<dim>::Identity(); ///< of its displacements, by way_of_centres()
  LinkTurns<dim> turns;                         ///< at which it holds
};

/// A link whose branch has turned and stretched with its grains. The displacement along n is the growth of the distance
/// of the centres; the slip is the angle by which the branch has turned, times its length at rest, less the angles by which
/// the grains have turned its normal, times their arms; the turn is that of the second grain from the first. A rigid rotation
/// of both grains is no motion; in space to the second order of their turns.
template <int dim>
class TurnedLink
{
public:
  /// The link with its grains at a position.
  TurnedLink(const Link<dim>& link, const Unknowns& position);

  /// Motion since rest [m, rad].
  const Motion<dim>& motion() const { return its_motion; }

  TurnedGradient<dim> gradient() const;

  /// Stiffness against displacements of the second centre that forces of the link, conjugate to its motion, add because
  /// they turn with the branch [N/m]. Symmetric; to first order in the angle of the branch.
  Tensor<dim> stiffness(const Motion<dim>& forces) const;

private:
  double length_at_rest;
  Vector<dim> end; ///< of the branch, in the axes at rest [m]
  double length;
  double slope;        ///< the angle of the branch over its way across the normal at rest, ψ/ρ [1/m]
  double slope_change; ///< (d(ψ/ρ)/dρ)/ρ [1/m³]
  LinkTurns<dim> turns;
  Motion<dim> its_motion;
};

/// Turn of a link: the way of its forces to its grains, and its stiffness beyond its law.
template <int dim>
struct LinkTurn
{
  TurnedGradient<dim> gradient;
  Tensor<dim> stiffness = Tensor<dim>::Zero(); ///< TurnedLink::stiffness() [N/m]
  Motion<dim> forces = Motion<dim>::Zero();    ///< of the link: its couples change with the turns [N, N m]
};

/// Small motion of a turned link.
template <int dim>
Motion<dim> link_motion(const Link<dim>& link, const TurnedGradient<dim>& gradient, const Unknowns& unknowns);

/// Adds what the forces of a turned link do: the transpose.
template <int dim>
void add_forces(const Link<dim>& link, const TurnedGradient<dim>& gradient, const Motion<dim>& forces, Unknowns& sum);

/// Adds the forces that a small motion makes, or several do, by the stiffness of the link and that of its turning.
template <int dim, typename Columns>
void add_forces_of_motion(const Link<dim>& link, const LinkTurn<dim>& turn, const JointStiffness<dim>& stiffness,
                          const Columns& motion, Columns& sum);
} // namespace feldspar

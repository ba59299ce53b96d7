#pragma once

#include "coupling/network/network.h"

/// How the boundary of an RVE acts on its elasticity: the same grains and joints under the weakest and
/// the strictest hold on their boundary. The periodic one lies between them; docs/theory.md §9.5.
namespace feldspar
{
template <int dim>
struct StiffnessBounds
{
  Stiffness<dim> minimal_kinematic; ///< [Pa], Voigt with engineering shear; zero where no joint leads over a side
  Stiffness<dim> affine;            ///< [Pa]
};

/// The bounds with all bonds intact. The body has the grains of the cell and the images that joints lead to, each a
/// pair with its own grain. Minimal kinematic (Mesarovic and Padbidri 2005): only the mean over the
/// pairs of each side follows the strain, which is a uniform traction on the sides. Affine: every grain of a pair is
/// displaced as the strain says, and may turn.
template <int dim>
StiffnessBounds<dim> stiffness_bounds(const Network<dim>& network);
} // namespace feldspar

#pragma once

#include "dem/dynamics/incidence.h"
#include "dem/dynamics/touches.h"
#include "dem/dynamics/walls.h"
#include "dem/specimen/rigid_groups.h"
#include "dem/specimen/specimen.h"

namespace feldspar
{
/// The largest stiffness over inertia of the first `n_own` grains, or of their rigid groups, k/m or k_rot/I [1/s²], with the contacts that press
/// now; where none does, of the stiffest contact a grain could make. The inverse of its root is the stable time step;
/// docs/theory.md §2.2.
template <int dim>
double largest_stiffness_over_inertia(const Specimen<dim>& body, const RigidGroups<dim>& groups, std::size_t n_own,
                                      const Incidence& joints_of, const Touches<dim>& touches, const Walls<dim>& walls);

/// The same of a body with its joints alone, which no wall presses.
template <int dim>
double largest_stiffness_over_inertia(const Specimen<dim>& body);
} // namespace feldspar

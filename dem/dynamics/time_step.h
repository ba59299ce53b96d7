#pragma once

#include "dem/dynamics/incidence.h"
#include "dem/dynamics/touches.h"
#include "dem/dynamics/walls.h"
#include "dem/specimen/rigid_groups.h"
#include "dem/specimen/specimen.h"

namespace feldspar
{
/// The largest stiffness over inertia of the own grains, or of the rigid groups, k/m or k_rot/I [1/s²], with the contacts that press
/// now; 0 where none does. The inverse of its root is the stable time step;
/// docs/theory.md §2.2.
template <int dim>
double largest_stiffness_over_inertia(const Specimen<dim>& body, const RigidGroups<dim>& groups, const GrainRange& own,
                                      const Incidence& joints_of, const Touches<dim>& touches, const Walls<dim>& walls);

/// The same of the stiffest contact that a grain of a body could make.
template <int dim>
double stiffness_over_inertia_of_touches(const Specimen<dim>& body);

/// The same of a body with its joints alone, which no wall presses, or else of its touches.
template <int dim>
double largest_stiffness_over_inertia(const Specimen<dim>& body);
} // namespace feldspar

#pragma once

#include "dem/minerals/parameters.h"
#include "dem/specimen/specimen.h"

namespace feldspar
{
/// Gives each grain of a specimen its mineral and its mineral grain (Specimen::groups), by a map or by Voronoi cells of the
/// minerals' shares and sizes, and each joint the ratios of where it stands; docs/theory.md §3.4. Throws InputError where the
/// minerals do not fit the specimen. Nothing where there are no minerals.
template <int dim>
void put_in_minerals(Specimen<dim>& specimen, const MineralParameters& wanted);

/// The specimen with the stiffness of its law at every joint, as it was before the minerals were put in.
template <int dim>
Specimen<dim> with_one_stiffness(Specimen<dim> specimen, const MineralParameters& wanted);
} // namespace feldspar

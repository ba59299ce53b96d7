#pragma once

#include "dem/dynamics/dynamics.h"
#include "laboratory/record.h"

namespace feldspar
{
/// The grains of the joint that broke.
template <int dim>
GrainPair ends_of(const Specimen<dim>& body, const Break& event);

/// The record of a break: its place and normal as the grains stand now, at an axial strain of the test.
template <int dim>
Crack crack(const Dynamics<dim>& dynamics, const Break& event, double axial_strain);
} // namespace feldspar

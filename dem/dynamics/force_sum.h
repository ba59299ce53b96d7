#pragma once

#include "dem/dynamics/incidence.h"
#include "dem/dynamics/touches.h"
#include "dem/specimen/specimen.h"

namespace feldspar
{
/// Sets force and couple of the first `n_own` grains to the sums over their joints and touches, grain by grain: in the
/// order of the contacts whatever the number of threads.
template <int dim>
void sum_forces(Specimen<dim>& body, std::size_t n_own, const IncidenceBySide& joints_of, const Touches<dim>& touches);
} // namespace feldspar

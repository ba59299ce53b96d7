#pragma once

#include "dem/dynamics/images.h"
#include "dem/dynamics/touches.h"
#include "dem/dynamics/walls.h"
#include "dem/specimen/specimen.h"

#include <vector>

/// Mean fields of the contact forces of a body.
namespace feldspar
{
/// -(1/V) Σ f ⊗ l over all contacts and walls [Pa], tension positive.
template <int dim>
Tensor<dim> mean_stress(const Specimen<dim>& body, const Touches<dim>& touches, const Walls<dim>& walls);

/// Stress of each grain, a pull > 0: Σ f ⊗ (x_c - x) over contacts at x_c, over its share of the body's volume, its own
/// over the solid share [Pa]; symmetric where its couples balance. Members of a rigid group have that of their group.
/// The stress of one grain scatters by the size of the stress; the mean over some tens of grains is that of the body
/// there. Of a shared body those of the own grains count. [n_grains]
template <int dim>
std::vector<Tensor<dim>> grain_stresses(const Specimen<dim>& body, const Touches<dim>& touches,
                                        const Walls<dim>& walls);

/// Mean stress of a periodic body from the contacts across the sides of the cell alone.
template <int dim>
Tensor<dim> boundary_stress(const Specimen<dim>& body, const Touches<dim>& touches, const Images<dim>& images);

/// Force that the grains above a plane across the last axis receive from those below, along that axis [N].
template <int dim>
double force_across(const Specimen<dim>& body, const BodyShare<dim>& share, const Touches<dim>& touches, double height);

/// Mean force over the joints and the pairs in contact [N]; 0 without any.
template <int dim>
double mean_contact_force(const Specimen<dim>& body, const BodyShare<dim>& share, const Touches<dim>& touches);
} // namespace feldspar

#pragma once

#include "dem/specimen/specimen.h"

#include <vector>

namespace feldspar
{
/// The specimen without the grains that are not kept and their joints; kept: [n_grains]. Joints keep their numbers. The
/// report's counts follow; what it tells of the packing stays that of the whole.
template <int dim>
Specimen<dim> part_of(Specimen<dim> specimen, const std::vector<bool>& kept);

/// Moved by so much, in a box of another size [m].
template <int dim>
Specimen<dim> shifted(Specimen<dim> specimen, const Vector<dim>& way, const Vector<dim>& size);

/// Specimen turned in space by a quarter about the first axis, so that the last axis runs across a cylinder and the
/// second along it; in the plane as it is.
template <int dim>
Specimen<dim> laid_on_side(Specimen<dim> specimen);

/// Turned by a quarter about the axis out of the picture, so that the axis of the tests becomes the first one. A cylinder
/// cannot be turned so: it stands about the last axis.
template <int dim>
Specimen<dim> quarter_turned(Specimen<dim> specimen);
} // namespace feldspar

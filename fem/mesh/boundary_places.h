#pragma once

#include "fem/mesh/sample_mesh.h"

namespace feldspar::fem
{
/// Checks that the boundaries of a laboratory test lie where their names say: bottom and top are the whole lower and upper
/// end, flat and level; left and right, in r-z axis and side, in space side alone lie about the sample and face the right
/// way. The last coordinate counts upwards. Other boundaries may lie where none of these has its place.
///
/// A place holds to within a thousandth of the width of the sample. Laboratories prepare the ends of a specimen so:
/// at most 0.05 mm in 50 mm out of square with its axis (ISRM, ASTM D4543).
///
/// Throws MeshError, which says what lies where. in_r_z: the first coordinate of a mesh in the plane is a radius.
template <int dim>
void check_places(const SampleMesh<dim>& mesh, bool in_r_z);
} // namespace feldspar::fem

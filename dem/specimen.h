#pragma once

#include "dem/grains.h"
#include "dem/joints.h"
#include "dem/lab_results.h"
#include "dem/parameters.h"

#include <cstdint>

namespace feldspar
{
/// Grains and the joints between them, stress free and at rest, in the box [0, size].
template <int dim>
struct Specimen
{
  Vector<dim> size = Vector<dim>::Zero(); ///< width, (depth,) height [m]; the last axis is that of the tests
  double thickness = 1.0;                 ///< of the plane [m]
  double bulk_density = 0.0;              ///< [kg/m³]
  std::uint64_t seed = 0;
  ParticleContactParameters particle_contact;
  Grains<dim> grains;
  Joints<dim> joints;
  SpecimenReport report;

  double volume() const { return size.prod() * (dim == 2 ? thickness : 1.0); }
};
} // namespace feldspar

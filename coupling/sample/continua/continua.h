#pragma once

#include "coupling/sample/sample_parameters.h"
#include "fem/materials/material.h"

/// The materials without grains that a sample may be made of, for comparison. Each is a constant in a file of its name;
/// continuum_of() lists them.
namespace feldspar
{
/// How a material is made of the entries of section Continuum.
struct Continuum
{
  fem::Material<2> (*in_plane)(const ContinuumParameters&); ///< shows its modulus and ratio free across the plane
  fem::Material<3> (*in_space)(const ContinuumParameters&);
};

namespace continua
{
extern const Continuum linear_elasticity;
extern const Continuum mohr_coulomb;
} // namespace continua

/// Throws std::invalid_argument for a material of grains. A material that is not listed does not compile.
const Continuum& continuum_of(SampleMaterial material);
} // namespace feldspar

#pragma once

#include "coupling/sample/continua/parameters.h"
#include "fem/materials/material.h"

#include <array>
#include <string_view>

/// The materials without grains that a sample may be made of, for comparison. Each is a constant in a file of its name. To
/// add one: its file, its lines here and in the list of continua.cc, its file in CMakeLists.txt.
namespace feldspar
{
/// A material, all there is to know about it: how it is made of the entries of section Continuum.
struct Continuum
{
  std::string_view name; ///< in the input
  bool softens = false;  ///< else a test of it ends at a strain that is given
  fem::Material<2> (*in_plane)(const ContinuumParameters&) = nullptr; ///< its modulus and ratio free across the plane
  fem::Material<3> (*in_space)(const ContinuumParameters&) = nullptr;
};

/// Names of the continua, in the order of the list, for an input that is read without finite elements.
inline constexpr std::array<std::string_view, 2> continuum_names{"linear elasticity", "Mohr-Coulomb"};

namespace continua
{
extern const Continuum linear_elasticity;
extern const Continuum mohr_coulomb;
} // namespace continua

/// Throws std::invalid_argument for a name that is not in the list.
const Continuum& continuum_of(std::string_view name);
} // namespace feldspar

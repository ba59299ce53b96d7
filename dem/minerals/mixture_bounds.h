#pragma once

#include <vector>

/// Bounds on the stiffness of a mixture of isotropic phases; docs/theory.md §3.4.
namespace feldspar
{
struct PhaseModuli
{
  double share;         ///< of the volume
  double bulk_modulus;  ///< [Pa]; in the plane that of plane strain
  double shear_modulus; ///< [Pa]
};

struct Moduli
{
  double bulk_modulus;  ///< [Pa]
  double shear_modulus; ///< [Pa]
};

struct MixtureBounds
{
  Moduli reuss;                  ///< all phases under one stress
  Moduli hashin_shtrikman_lower; ///< isotropic mixtures
  Moduli hashin_shtrikman_upper;
  Moduli voigt; ///< all phases under one strain
};

/// Hashin and Shtrikman 1963 in space, Hashin 1965 in the plane; of phases whose moduli grow together.
template <int dim>
MixtureBounds mixture_bounds(const std::vector<PhaseModuli>& phases);
} // namespace feldspar

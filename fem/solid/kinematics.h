#pragma once

#include "fem/materials/material.h"

#include <numbers>
#include <string>
#include <vector>

/// Strain of a material point by a displacement field on a mesh.
///
/// | kinematics   | mesh        | material | material's x, y, z          | weight of an area |
/// |--------------|-------------|----------|-----------------------------|-------------------|
/// | plane        | 2D (x, y)   | 2D       | x, y                        | 1 m               |
/// | plane        | 2D (x, y)   | 3D       | x, out of the plane, y      | 1 m               |
/// | axisymmetric | 2D (r, z)   | 3D       | r, around the axis, z       | 2πr               |
/// | full         | 3D          | 3D       | x, y, z                     | 1                 |
///
/// The axis of the sample, its last coordinate, is therefore always the last of the material.
namespace feldspar::fem
{
enum class Kinematics
{
  plane, ///< nothing strains out of the plane
  axisymmetric,
  full
};

/// Strain of a displacement along one coordinate of the mesh with this value and gradient [dim], at a distance from
/// the axis [m] (axisymmetric only).
template <int dim, int material_dim, typename Gradient>
StrainVector<material_dim> strain_of(const Kinematics kinematics, const unsigned int component, const double value,
                                     const Gradient& gradient, const double radius)
{
  static_assert(dim <= material_dim);
  StrainVector<material_dim> strain = StrainVector<material_dim>::Zero();
  if constexpr (dim == 2 && material_dim == 2)
    {
      strain[component] = gradient[component];
      strain[2] = gradient[1 - component];
    }
  else if constexpr (dim == 2)
    {
      constexpr int xx = 0, yy = 1, zz = 2, xz = 4;
      strain[component == 0 ? xx : zz] = gradient[component];
      strain[xz] = gradient[1 - component];
      if (kinematics == Kinematics::axisymmetric && component == 0)
        strain[yy] = value / radius;
    }
  else
    {
      strain[component] = gradient[component];
      for (unsigned int other = 0; other < 3; ++other)
        if (other != component)
          strain[6 - component - other] = gradient[other]; // yz, xz, xy are 3, 4, 5
    }
  return strain;
}

/// The weight of an area or volume of the mesh.
inline double weight(const Kinematics kinematics, const double radius)
{
  return kinematics == Kinematics::axisymmetric ? 2.0 * std::numbers::pi * radius : 1.0;
}

/// Names of the material's components in the coordinates of the mesh; empty where the component is always zero.
template <int dim, int material_dim>
std::vector<std::string> component_names(const Kinematics kinematics)
{
  if constexpr (dim < material_dim)
    return kinematics == Kinematics::axisymmetric ? std::vector<std::string>{"rr", "tt", "zz", "", "rz", ""}
                                                  : std::vector<std::string>{"xx", "zz", "yy", "", "xy", ""};
  std::vector<std::string> names;
  for (int k = 0; k < n_voigt<dim>; ++k)
    names.push_back(voigt_name<dim>(k));
  return names;
}
} // namespace feldspar::fem

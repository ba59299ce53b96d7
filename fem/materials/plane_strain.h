#pragma once

#include "fem/materials/forwarding_point.h"

#include <array>
#include <memory>

namespace feldspar::fem
{
/// The plane in space where nothing strains across: x and y of the plane are x and z of the material, as in kinematics.h.
struct PlaneWithinSpace
{
  static constexpr int inner_dim = 3;
  static constexpr std::array place{0, 2, 4}; ///< xx, zz, xz of xx, yy, zz, yz, xz, xy

  static StrainVector<3> strain_within(const StrainVector<2>& strain)
  {
    StrainVector<3> result = StrainVector<3>::Zero();
    for (int i = 0; i < 3; ++i)
      result[place[i]] = strain[i];
    return result;
  }
  static StressVector<2> stress_without(const StressVector<3>& stress)
  {
    return {stress[place[0]], stress[place[1]], stress[place[2]]};
  }
  static StiffnessMatrix<2> tangent_without(const StiffnessMatrix<3>& tangent)
  {
    StiffnessMatrix<2> result;
    for (int i = 0; i < 3; ++i)
      for (int j = 0; j < 3; ++j)
        result(i, j) = tangent(place[i], place[j]);
    return result;
  }
  /// Projection of a direction on the plane.
  static Eigen::Vector2d direction_without(const Eigen::Vector3d& direction) { return {direction[0], direction[2]}; }
};

/// A material in space as one in the plane.
inline Material<2> plane_strain(const Material<3>& in_space)
{
  using PlaneStrainPoint = ForwardingPoint<2, PlaneWithinSpace>;
  return {[make = in_space.make_point](const PointPlace& at) { return std::make_unique<PlaneStrainPoint>(make(at)); },
          in_space.field_names};
}
} // namespace feldspar::fem

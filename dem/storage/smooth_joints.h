#pragma once

#include "base/vector.h"
#include "dem/laws/contact_motion.h"
#include "dem/laws/face_elements.h"
#include "dem/laws/smooth_joint.h"
#include "dem/storage/grains.h"

#include <Eigen/Geometry>

#include <array>
#include <cstdint>
#include <type_traits>
#include <utility>

namespace feldspar
{
/// Two grains on either side of a smooth plane, and the share of the plane that is theirs. They stand in a list of their
/// own beside the joints of the specimen's law: a specimen without any pays nothing for them.
template <int dim>
struct SmoothJoint
{
  std::uint32_t grain_1 = 0, grain_2 = 0; ///< the first the lower number
  std::uint32_t number = 0;               ///< behind those of the other joints, for good
  double area = 0.0;                      ///< [m²]
  double half_radius_difference = 0.0;    ///< ½(R1 - R2) [m]
  std::array<double, dim> normal{};       ///< of the plane, from the side of grain 1 to that of grain 2; fixed
  std::array<double, dim> branch{};       ///< from centre 1 to centre 2 [m]
  smooth_joint::Face face{};
  smooth_joint::State<dim> state{};
  double opening = 0.0;                            ///< of the sides since installation, dilation included [m]
  std::array<double, dim - 1> slip{};              ///< along the axes of the plane since installation [m]
  double slip_energy = 0.0;                        ///< dissipated by friction since installation [J]
  std::array<double, dim> force{};                 ///< on grain 2 [N]
  std::array<double, n_rotations<dim>> couple_1{}; ///< on grain 1 [N m]
  std::array<double, n_rotations<dim>> couple_2{}; ///< on grain 2 [N m]

  std::pair<std::uint32_t, std::uint32_t> ends() const { return {grain_1, grain_2}; }
  double stored_energy() const { return area * smooth_joint::stored_energy(face, state); } ///< [J]
  /// The size of its share of the plane: length in 2D, root of the area in 3D [m].
  double size(const double thickness) const { return dim == 2 ? area / thickness : std::sqrt(area); }
};

static_assert(std::is_trivially_copyable_v<SmoothJoint<2>> && std::is_trivially_copyable_v<SmoothJoint<3>>);

/// t, or t_1 and t_2 of a plane with this normal.
template <int dim>
std::array<Vector<dim>, dim - 1> plane_axes(const Vector<dim>& normal)
{
  if constexpr (dim == 2)
    return {Vector<2>(-normal[1], normal[0])};
  else
    {
      const auto t = space::tangent_to({normal[0], normal[1], normal[2]});
      const Vector<3> tangent(t[0], t[1], t[2]);
      return {tangent, normal.cross(tangent)};
    }
}

/// Share of the branch from grain 1 to the point at which the sides meet, in the middle of overlap or gap.
template <int dim>
double share_of_grain_1(const SmoothJoint<dim>& joint, const Vector<dim>& branch)
{
  return 0.5 + joint.half_radius_difference / branch.norm();
}
} // namespace feldspar

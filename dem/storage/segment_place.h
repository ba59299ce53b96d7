#pragma once

#include "dem/laws/contact_motion.h"
#include "dem/storage/joints.h"

#include <Eigen/Geometry>

#include <array>
#include <cmath>
#include <cstddef>

/// Positions of the segments of faces, and of the cracks that they become.
namespace feldspar
{
template <int dim>
struct SegmentPlace
{
  Vector<dim> centroid; ///< [m]
  Vector<dim> normal;   ///< from grain 1 to grain 2
  double size;          ///< length in 2D, root of the area in 3D [m]
};

/// Place of an element of a face with axes n, t (n, t_1, t_2) as rows; arm: from the centre of grain 1 to the middle of
/// the face [m].
template <int dim>
SegmentPlace<dim> segment_place(const Vector<dim>& centre_1, const double arm, const Tensor<dim>& axes,
                                const double half_length, const FaceElement<dim>& element)
{
  const Vector<dim> normal = axes.row(0);
  Vector<dim> from_middle;
  if constexpr (dim == 2)
    from_middle = half_length * element.offset[0] * axes.row(1).transpose();
  else
    from_middle = half_length * (element.offset[0] * axes.row(1) + element.offset[1] * axes.row(2)).transpose();
  return {centre_1 + arm * normal + from_middle, normal,
          half_length * (dim == 2 ? element.area : std::sqrt(element.area))};
}

/// t, or t_1 and t_2, of a face.
template <int dim>
std::array<Vector<dim>, dim - 1> face_axes(const Joints<dim>& joints, const std::size_t joint)
{
  const Vector<dim> normal = at<dim>(joints.normal, joint);
  if constexpr (dim == 2)
    return {Vector<2>(-normal[1], normal[0])};
  else
    {
      const Vector<3> tangent = at<3>(joints.tangent, joint);
      return {tangent, normal.cross(tangent)};
    }
}

/// The place of a segment of a joint as its grains stand now.
template <int dim>
SegmentPlace<dim> segment_place(const Grains<dim>& grains, const Joints<dim>& joints, const std::size_t joint,
                                const std::size_t segment)
{
  Tensor<dim> axes;
  axes.row(0) = at<dim>(joints.normal, joint);
  const auto in_face = face_axes(joints, joint);
  for (int c = 1; c < dim; ++c)
    axes.row(c) = in_face[c - 1];
  const double distance = joints.rest_distance[joint] + joints.opening[joint];
  return segment_place<dim>(at<dim>(grains.position, joints.grain_1[joint]),
                            arms(distance, joints.half_radius_difference[joint]).one, axes, joints.half_length[joint],
                            joints.elements[segment]);
}
} // namespace feldspar

#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <vector>

/// The faces of a joint: their size, stiffness and division into segments (2D) or elements (3D); docs/theory.md §1.1.
namespace feldspar
{
/// k_n = E/(R1 + R2), stress per displacement [Pa/m].
inline double stiffness_per_area(const double modulus, const double radius_1, const double radius_2)
{
  return modulus / (radius_1 + radius_2);
}

/// R̄ = λ min(R1, R2) [m]; (12). Half the length of the face in 2D, its radius in 3D.
inline double face_half_length(const double radius_multiplier, const double radius_1, const double radius_2)
{
  return radius_multiplier * std::min(radius_1, radius_2);
}

/// 2R̄t or πR̄² [m²].
template <int dim, typename Real>
Real face_area(const Real& half_length, const double thickness)
{
  if constexpr (dim == 2)
    return 2.0 * half_length * thickness;
  else
    return std::numbers::pi * half_length * half_length;
}

/// About an axis in the plane of the face, ⅔R̄³t or ¼πR̄⁴ [m⁴].
template <int dim, typename Real>
Real face_second_moment(const Real& half_length, const double thickness)
{
  const Real& r = half_length;
  if constexpr (dim == 2)
    return 2.0 / 3.0 * r * r * r * thickness;
  else
    return 0.25 * std::numbers::pi * r * r * r * r;
}

/// About the normal of the face, ½πR̄⁴ [m⁴]; a face in the plane does not twist.
template <int dim, typename Real>
Real face_polar_moment(const Real& half_length)
{
  if constexpr (dim == 2)
    return Real(0.0);
  else
    return 2.0 * face_second_moment<dim>(half_length, 1.0);
}

/// Normal stiffness of two grains in contact without a face, that of a face as wide as the smaller grain [N/m].
template <int dim>
double touch_stiffness(const double modulus, const double radius_1, const double radius_2, const double thickness)
{
  return stiffness_per_area(modulus, radius_1, radius_2) * face_area<dim>(std::min(radius_1, radius_2), thickness);
}

/// One element of a face, in units of R̄.
template <int dim>
struct FaceElement
{
  std::array<double, dim - 1> offset; ///< of the centroid: along t in 2D; along the face's axes t_1, t_2 in 3D
  double area;                        ///< over R̄t in 2D, over R̄² in 3D
  double second_moment; ///< own, about its centroid: ℓ³/12 over R̄³ in 2D; 0 in 3D, where it is lumped
};

/// N equal segments from ρ = +R̄ to -R̄; (8).
template <int dim>
requires(dim == 2) std::vector<FaceElement<dim>> face_elements(const unsigned int n_segments)
{
  std::vector<FaceElement<dim>> elements;
  const double length = 2.0 / n_segments;
  for (unsigned int i = 0; i < n_segments; ++i)
    elements.push_back(
      {{(double(n_segments) - 1.0 - 2.0 * i) / n_segments}, length, length * length * length * (1.0 / 12.0)});
  return elements;
}

/// N_r rings of equal width times N_α sectors of equal angle, counted from t_1 to t_2, ring by ring from the middle.
template <int dim>
requires(dim == 3) std::vector<FaceElement<dim>> face_elements(const unsigned int n_rings, const unsigned int n_sectors)
{
  std::vector<FaceElement<dim>> elements;
  const double angle = 2.0 * std::numbers::pi / n_sectors;
  const double chord = std::sin(0.5 * angle) / (0.5 * angle);
  for (unsigned int ring = 0; ring < n_rings; ++ring)
    {
      const double inner = double(ring) / n_rings;
      const double outer = double(ring + 1) / n_rings;
      const double squares = outer * outer - inner * inner;
      const double cubes = outer * outer * outer - inner * inner * inner;
      const double radius = 2.0 / 3.0 * cubes / squares * chord; // of the centroid
      for (unsigned int sector = 0; sector < n_sectors; ++sector)
        {
          const double at = (sector + 0.5) * angle;
          elements.push_back({{radius * std::cos(at), radius * std::sin(at)}, 0.5 * angle * squares, 0.0});
        }
    }
  return elements;
}

/// A face as one spring, while all its elements are bonded: sums over them, in units of R̄. Their first moments and, in 3D,
/// their product of inertia vanish by the symmetry of the division.
template <int dim>
struct WholeFace
{
  double area = 0.0;                           ///< over R̄t in 2D, over R̄² in 3D
  std::array<double, dim - 1> second_moment{}; ///< of the offsets along each axis, own ones included: over R̄³t, R̄⁴
  std::array<double, dim - 1> farthest_offset{}; ///< of a centroid along each axis
};

template <int dim>
WholeFace<dim> whole_face(const std::vector<FaceElement<dim>>& elements)
{
  WholeFace<dim> whole;
  for (const auto& element : elements)
    {
      whole.area += element.area;
      for (int c = 0; c < dim - 1; ++c)
        {
          whole.second_moment[c] += element.area * element.offset[c] * element.offset[c] + element.second_moment;
          whole.farthest_offset[c] = std::max(whole.farthest_offset[c], std::abs(element.offset[c]));
        }
    }
  return whole;
}

/// Division of a face into elements: {N} in the plane, {N_r, N_α} in space.
template <int dim>
using FaceDivision = std::array<unsigned int, dim - 1>;

template <int dim>
std::vector<FaceElement<dim>> face_elements(const FaceDivision<dim>& division)
{
  if constexpr (dim == 2)
    return face_elements<2>(division[0]);
  else
    return face_elements<3>(division[0], division[1]);
}
} // namespace feldspar

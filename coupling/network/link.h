#pragma once

#include "coupling/network/voigt.h"
#include "dem/laws/face.h"

#include <cstdint>

/// A contact of two grains in small strains: how it moves with them, and what its forces do to them.
namespace feldspar
{
/// Motions of all grains, [n_motions * n_grains], then the macroscopic strain, [n_voigt].
using Unknowns = Eigen::VectorXd;

/// Motion of a link from the motions of both its grains, and from the macroscopic strain.
template <int dim>
using LinkGradient = Eigen::Matrix<double, n_motions<dim>, 2 * n_motions<dim>>;
template <int dim>
using LinkStrainGradient = Eigen::Matrix<double, n_motions<dim>, n_voigt<dim>>;

/// Two grains joined by a face, or, without a face, near enough that they may come to touch: then a single element in
/// the middle that carries no tension and no moment.
template <int dim>
struct Link
{
  std::uint32_t grain_1, grain_2;
  std::uint32_t first_segment; ///< among all segments of the network
  std::uint32_t n_segments;
  bool has_face;
  Tensor<dim> axes;        ///< rows n, t (n, t_1, t_2)
  Vector<dim> branch;      ///< from centre 1 to centre 2, through the periodic image [m]
  double arm_1, arm_2;     ///< from the centres to the contact point [m]
  double normal_stiffness; ///< k_n [Pa/m]
  double shear_stiffness;  ///< k_s [Pa/m]
  double half_length;      ///< R̄ [m]
  double opening;          ///< g_0 at rest [m]
  double friction;

  Face<double> face(const double thickness) const
  {
    return {normal_stiffness, shear_stiffness, half_length, thickness, friction};
  }

  LinkGradient<dim> by_grains{};
  LinkStrainGradient<dim> by_strain{};
};

/// The gradient of a link with these axes, arms and branch; docs/theory.md §9.1.
template <int dim>
LinkGradient<dim> link_gradient(const Link<dim>& link);
template <int dim>
LinkStrainGradient<dim> link_strain_gradient(const Link<dim>& link);

/// Motion of a link.
template <int dim>
Motion<dim> link_motion(const Link<dim>& link, const Unknowns& unknowns)
{
  constexpr int n = n_motions<dim>;
  return link.by_grains.template leftCols<n>() * unknowns.segment<n>(n * Eigen::Index(link.grain_1)) +
         link.by_grains.template rightCols<n>() * unknowns.segment<n>(n * Eigen::Index(link.grain_2)) +
         link.by_strain * unknowns.tail<n_voigt<dim>>();
}

/// Adds what a link's forces do to its grains and to volume × stress: the transpose of link_motion().
template <int dim>
void add_forces(const Link<dim>& link, const Motion<dim>& forces, Unknowns& sum)
{
  constexpr int n = n_motions<dim>;
  sum.segment<n>(n * Eigen::Index(link.grain_1)) += link.by_grains.template leftCols<n>().transpose() * forces;
  sum.segment<n>(n * Eigen::Index(link.grain_2)) += link.by_grains.template rightCols<n>().transpose() * forces;
  sum.tail<n_voigt<dim>>() += link.by_strain.transpose() * forces;
}
} // namespace feldspar

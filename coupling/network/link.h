#pragma once

#include "coupling/network/voigt_tensor.h"
#include "dem/laws/face.h"

#include <cstdint>

/// A contact of two grains in small strains: how it moves with them, and what its forces do to them.
namespace feldspar
{
/// Motions of all grains, [n_motions * n_grains], then the macroscopic strain, [n_voigt].
using Unknowns = Eigen::VectorXd;

/// Unknowns under each unit strain, side by side, [unknowns × n_voigt and zeros]: a row is one vector of the processor.
template <int dim>
using UnitUnknowns = Eigen::Matrix<double, Eigen::Dynamic, dim == 2 ? 4 : 8, Eigen::RowMajor>;

/// The same of a link, a grain, or whatever has so few rows.
template <int n_rows, typename Columns>
using RowsOf = Eigen::Matrix<double, n_rows, Columns::ColsAtCompileTime, Columns::Options>;

/// Motion of a link from the motions of both its grains, and from the macroscopic strain.
template <int dim>
using LinkGradient = Eigen::Matrix<double, n_motions<dim>, 2 * n_motions<dim>>;
template <int dim>
using LinkStrainGradient = Eigen::Matrix<double, n_motions<dim>, n_voigt<dim>>;

/// Two grains joined by a face, or, without a face, near enough that they may come into contact: then a single element
/// in the middle that carries no tension and no moment.
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

/// Displacement of the second centre relative to the first, beyond the branch at rest, in the axes at rest [m]. This
/// function and those below use the axes, the arms and the branch: the gradients, half of which are zeros, would take
/// three times as long.
template <int dim, typename Columns>
RowsOf<dim, Columns> way_of_centres(const Link<dim>& link, const Columns& unknowns)
{
  constexpr int n = n_motions<dim>;
  RowsOf<dim, Columns> way = unknowns.template middleRows<dim>(n * Eigen::Index(link.grain_2)) -
                             unknowns.template middleRows<dim>(n * Eigen::Index(link.grain_1));
  const auto strain = unknowns.template bottomRows<n_voigt<dim>>();
  for (int k = 0; k < n_voigt<dim>; ++k)
    {
      const auto [i, j] = voigt_pair<dim>(k);
      if (i == j)
        way.row(i) += link.branch[i] * strain.row(k);
      else
        {
          way.row(i) += 0.5 * link.branch[j] * strain.row(k);
          way.row(j) += 0.5 * link.branch[i] * strain.row(k);
        }
    }
  return link.axes * way;
}

/// The motion of a link under the turns of its grains.
template <int dim, typename Columns>
RowsOf<n_motions<dim>, Columns> motion_by_turns(const Link<dim>& link, const Columns& unknowns)
{
  constexpr int n = n_rotations<dim>;
  const auto turn_1 = unknowns.template middleRows<n>(n_motions<dim> * Eigen::Index(link.grain_1) + dim);
  const auto turn_2 = unknowns.template middleRows<n>(n_motions<dim> * Eigen::Index(link.grain_2) + dim);
  RowsOf<n_motions<dim>, Columns> motion;
  motion.row(0).setZero();
  if constexpr (dim == 2)
    {
      motion.row(1) = -link.arm_1 * turn_1 - link.arm_2 * turn_2;
      motion.row(2) = turn_2 - turn_1;
    }
  else
    {
      const RowsOf<3, Columns> own_1 = link.axes * turn_1, own_2 = link.axes * turn_2;
      motion.row(1) = -link.arm_1 * own_1.row(2) - link.arm_2 * own_2.row(2);
      motion.row(2) = link.arm_1 * own_1.row(1) + link.arm_2 * own_2.row(1);
      motion.template bottomRows<3>() = own_2 - own_1;
    }
  return motion;
}

/// Adds forces on the second centre, in the axes at rest, against them on the first, and what they do to volume × stress: the
/// transpose of way_of_centres().
template <int dim, typename Columns>
void add_on_centres(const Link<dim>& link, const RowsOf<dim, Columns>& force, Columns& sum)
{
  constexpr int n = n_motions<dim>;
  const RowsOf<dim, Columns> on_two = link.axes.transpose() * force;
  sum.template middleRows<dim>(n * Eigen::Index(link.grain_1)) -= on_two;
  sum.template middleRows<dim>(n * Eigen::Index(link.grain_2)) += on_two;
  auto of_strain = sum.template bottomRows<n_voigt<dim>>();
  for (int k = 0; k < n_voigt<dim>; ++k)
    {
      const auto [i, j] = voigt_pair<dim>(k);
      if (i == j)
        of_strain.row(k) += link.branch[i] * on_two.row(i);
      else
        of_strain.row(k) += 0.5 * (link.branch[j] * on_two.row(i) + link.branch[i] * on_two.row(j));
    }
}

/// Adds what a link's forces do to the turns of its grains: the transpose of motion_by_turns().
template <int dim, typename Columns>
void add_couples(const Link<dim>& link, const RowsOf<n_motions<dim>, Columns>& forces, Columns& sum)
{
  constexpr int n = n_rotations<dim>;
  RowsOf<n, Columns> on_1, on_2;
  on_2 = forces.template bottomRows<n>();
  on_1 = -on_2;
  if constexpr (dim == 2)
    {
      on_1 -= link.arm_1 * forces.row(1);
      on_2 -= link.arm_2 * forces.row(1);
    }
  else
    {
      on_1.row(1) += link.arm_1 * forces.row(2);
      on_1.row(2) -= link.arm_1 * forces.row(1);
      on_2.row(1) += link.arm_2 * forces.row(2);
      on_2.row(2) -= link.arm_2 * forces.row(1);
      on_1 = (link.axes.transpose() * on_1).eval();
      on_2 = (link.axes.transpose() * on_2).eval();
    }
  sum.template middleRows<n>(n_motions<dim> * Eigen::Index(link.grain_1) + dim) += on_1;
  sum.template middleRows<n>(n_motions<dim> * Eigen::Index(link.grain_2) + dim) += on_2;
}

/// Motion of a link: its gradients times the unknowns.
template <int dim, typename Columns>
RowsOf<n_motions<dim>, Columns> link_motion(const Link<dim>& link, const Columns& unknowns)
{
  RowsOf<n_motions<dim>, Columns> motion = motion_by_turns(link, unknowns);
  motion.template topRows<dim>() += way_of_centres(link, unknowns);
  return motion;
}

/// Adds what a link's forces do to its grains and to volume × stress: the transpose of link_motion().
template <int dim, typename Columns>
void add_forces(const Link<dim>& link, const RowsOf<n_motions<dim>, Columns>& forces, Columns& sum)
{
  add_on_centres<dim, Columns>(link, forces.template topRows<dim>(), sum);
  add_couples(link, forces, sum);
}
} // namespace feldspar

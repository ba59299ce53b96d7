#include "coupling/network/rigid_motions.h"

#include <Eigen/Geometry>
#include <Eigen/QR>

#include <algorithm>
#include <utility>

namespace feldspar
{
namespace
{
/// Displacement by a small rotation about the origin, about the axis `r`, per unit of its angle.
Vector<2> displacement_of_turn(const Vector<2>& place, int) { return {-place[1], place[0]}; }
Vector<3> displacement_of_turn(const Vector<3>& place, const int r)
{
  return Vector<3>(Vector<3>::Unit(r)).cross(place);
}

/// A joint as one of its grains sees it.
template <int dim>
struct Way
{
  std::uint32_t to;
  Vector<dim> branch; ///< [m]
};
} // namespace

template <int dim>
RigidMotions<dim>::RigidMotions(const std::vector<Link<dim>>& links, const std::size_t n_joints,
                                const std::size_t n_grains, const std::vector<std::uint32_t>& bound)
{
  std::vector<bool> is_bound(n_grains, false);
  for (const std::uint32_t grain : bound)
    is_bound[grain] = true;
  std::vector<std::vector<Way<dim>>> ways(n_grains);
  for (std::size_t j = 0; j < n_joints; ++j)
    {
      ways[links[j].grain_1].push_back({links[j].grain_2, links[j].branch});
      ways[links[j].grain_2].push_back({links[j].grain_1, -links[j].branch});
    }

  constexpr double same_place = 1e-3; // of a branch; an image lies at least an edge of the cell away
  std::vector<bool> is_placed(n_grains, false);
  std::vector<Vector<dim>> place(n_grains, Vector<dim>::Zero());
  for (std::uint32_t start = 0; start < n_grains; ++start)
    {
      if (is_placed[start] || ways[start].empty())
        continue;
      Group group{{start}, {}};
      is_placed[start] = true;
      bool hangs_on_image = false;
      for (std::size_t k = 0; k < group.grains.size(); ++k)
        for (const auto& way : ways[group.grains[k]])
          {
            const Vector<dim> there = place[group.grains[k]] + way.branch;
            if (!is_placed[way.to])
              {
                is_placed[way.to] = true;
                place[way.to] = there;
                group.grains.push_back(way.to);
              }
            else if ((there - place[way.to]).norm() > same_place * way.branch.norm())
              hangs_on_image = true;
          }

      if (std::ranges::any_of(group.grains, [&](const auto grain) { return is_bound[grain]; }))
        continue;

      constexpr int n = n_motions<dim>;
      const int n_turns = hangs_on_image ? 0 : n_rotations<dim>;
      Vector<dim> middle = Vector<dim>::Zero();
      for (const std::uint32_t grain : group.grains)
        middle += place[grain] / double(group.grains.size());
      Eigen::MatrixXd motions = Eigen::MatrixXd::Zero(n * Eigen::Index(group.grains.size()), dim + n_turns);
      for (std::size_t k = 0; k < group.grains.size(); ++k)
        {
          const Eigen::Index row = n * Eigen::Index(k);
          motions.template block<dim, dim>(row, 0).setIdentity();
          for (int r = 0; r < n_turns; ++r)
            {
              motions.template block<dim, 1>(row, dim + r) =
                displacement_of_turn(Vector<dim>(place[group.grains[k]] - middle), r);
              motions(row + dim + r, dim + r) = 1.0;
            }
        }
      const Eigen::HouseholderQR<Eigen::MatrixXd> factors(motions);
      group.motions = factors.householderQ() * Eigen::MatrixXd::Identity(motions.rows(), motions.cols());
      groups.push_back(std::move(group));
    }
}

template <int dim>
Unknowns RigidMotions<dim>::removed_from(Unknowns unknowns) const
{
  constexpr int n = n_motions<dim>;
  for (const Group& group : groups)
    {
      Eigen::VectorXd part = Eigen::VectorXd::Zero(group.motions.cols());
      for (std::size_t k = 0; k < group.grains.size(); ++k)
        part += group.motions.template middleRows<n>(n * Eigen::Index(k)).transpose() *
                unknowns.segment<n>(n * Eigen::Index(group.grains[k]));
      for (std::size_t k = 0; k < group.grains.size(); ++k)
        unknowns.segment<n>(n * Eigen::Index(group.grains[k])) -=
          group.motions.template middleRows<n>(n * Eigen::Index(k)) * part;
    }
  return unknowns;
}

template class RigidMotions<2>;
template class RigidMotions<3>;
} // namespace feldspar

#pragma once

#include "coupling/network/link.h"

#include <cstddef>
#include <cstdint>
#include <vector>

namespace feldspar
{
/// The motions of grains that strain no joint while all bonds hold: grains that are connected shift as one, and turn as
/// one where they do not hang on images of their own. (What hangs on its images along one axis only, in space, could
/// also turn about that axis; that motion is not among them.)
///
/// Forces of the network do no work on them, but round-off does; a nearly singular factor multiplies it by the inverse of
/// its regularity. Without them, conjugate gradients see the regular part of the network alone.
template <int dim>
class RigidMotions
{
public:
  /// The first `n_joints` of the links hold; a grain without any has no motion here, as no force acts on it. Nor have groups
  /// with one of the `bound` grains: forces of the boundary act on these.
  RigidMotions(const std::vector<Link<dim>>& links, std::size_t n_joints, std::size_t n_grains,
               const std::vector<std::uint32_t>& bound = {});

  /// Forces, or motions, less their projection on the rigid motions; strains stay as they are.
  Unknowns removed_from(Unknowns unknowns) const;

private:
  struct Group
  {
    std::vector<std::uint32_t> grains;
    Eigen::MatrixXd motions; ///< [n_motions * n_grains of the group × n], orthonormal
  };
  std::vector<Group> groups;
};
} // namespace feldspar

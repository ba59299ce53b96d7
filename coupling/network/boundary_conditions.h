#pragma once

#include "coupling/network/link.h"

#include <Eigen/Cholesky>

#include <cstddef>
#include <cstdint>
#include <functional>
#include <vector>

/// The boundary of a cell as conditions on the motions of its grains; docs/theory.md §9.6.
namespace feldspar
{
/// Conditions of a boundary on the motions u of grains beside the affine ones: B u = 0, and no displacement of the
/// grains that it holds. All motions of a network go through these conditions; forces that do no work on such motions
/// are carried by the boundary.
template <int dim>
class BoundaryConditions
{
public:
  /// A grain and its image on the other side.
  struct Pair
  {
    std::uint32_t image, owner;
    double share; ///< of the traction of its piece, negative on a lower side; of a piece the sizes add up to 1
  };
  /// The shares of its displacements add up to nothing.
  using Piece = std::vector<Pair>;

  BoundaryConditions() = default;
  /// `turn_alike`: the two of a pair also have the same rotation.
  BoundaryConditions(std::vector<Piece> pieces, bool turn_alike, std::vector<std::uint32_t> held);

  bool are_none() const { return all_pieces.empty() && held_grains.empty(); }
  const std::vector<Piece>& pieces() const { return all_pieces; }
  const std::vector<std::uint32_t>& held() const { return held_grains; }

  /// Grains on which a piece or a hold acts.
  std::vector<std::uint32_t> grains() const;

  /// Returns the conditions without the pairs whose two grains are no longer in one fragment: nothing holds one of them
  /// against the traction on the other. Fragments follow from the joints that hold; joints are the first of the links.
  /// The other pairs of the piece take their share.
  BoundaryConditions that_bear(const std::vector<Link<dim>>& links, std::size_t n_joints, std::size_t n_grains,
                               const std::function<bool(std::uint32_t joint)>& holds) const;

  /// Motions less what the conditions do not admit; forces less what the boundary carries. The orthogonal projection.
  void project(Eigen::VectorXd& motions_or_forces) const;

  /// B u.
  Eigen::VectorXd violations(const Eigen::VectorXd& motions) const;
  /// Bᵀ λ; λ are the tractions of the pieces, component by component [N], then the couples of the pairs [N m].
  void add_reactions(const Eigen::VectorXd& multipliers, double factor, Eigen::VectorXd& forces) const;
  Eigen::Index n_multipliers() const { return Eigen::Index(rows.size()); }
  /// λ that carries most of these forces, by least squares.
  Eigen::VectorXd multipliers(const Eigen::VectorXd& forces) const;

private:
  struct Entry
  {
    Eigen::Index motion;
    double value;
  };

  std::vector<Piece> all_pieces;
  bool pairs_turn_alike = false;
  std::vector<std::uint32_t> held_grains;
  std::vector<std::vector<Entry>> rows; ///< of B
  Eigen::LDLT<Eigen::MatrixXd> gram;    ///< B Bᵀ
};
} // namespace feldspar

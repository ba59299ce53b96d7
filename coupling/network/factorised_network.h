#pragma once

#include "coupling/network/block_factor.h"
#include "coupling/network/boundary_conditions.h"
#include "coupling/network/link.h"

#include <Eigen/Cholesky>

#include <cstdint>
#include <memory>
#include <vector>

// Ceres's static library holds some of Eigen's functions too (those that order a matrix). One copy serves the program:
// both must take and free memory alike.
static_assert(EIGEN_MALLOC_ALREADY_ALIGNED && EIGEN_DEFAULT_ALIGN_BYTES == 16,
              "Eigen would allocate otherwise than in the libraries of the distribution");

namespace feldspar
{
/// The stiffness of each link in its own axes, null where it has none at present; [n_links].
template <int dim>
using LinkStiffnesses = std::vector<const JointStiffness<dim>*>;

/// A network with given stiffnesses, solved directly: nearly the inverse of its equations, for conjugate gradients. Copies
/// share the factor.
template <int dim>
class FactorisedNetwork
{
public:
  /// `regularising`: of each motion of a grain, added so that what floats does not make the matrix singular [N/m, N m].
  /// Motions are those that the conditions admit.
  FactorisedNetwork(const std::vector<Link<dim>>& links, std::size_t n_grains,
                    std::shared_ptr<const BoundaryConditions<dim>> conditions, const LinkStiffnesses<dim>& stiffnesses,
                    const Motion<dim>& regularising);

  /// The same factor under other conditions, which hold the same grains.
  FactorisedNetwork under(std::shared_ptr<const BoundaryConditions<dim>> others) const;
  const std::shared_ptr<const BoundaryConditions<dim>>& conditions() const { return its_conditions; }

  /// Motions for forces on grains and on the free strains; the other strains stay.
  Unknowns solve(const Unknowns& forces, const std::array<bool, n_voigt<dim>>& strain_is_free) const;

  /// Motions for several forces on grains, side by side; the strain stays.
  UnitUnknowns<dim> solve_with_strain_held(const UnitUnknowns<dim>& forces) const;

  /// Number of iterations of conjugate gradients that cost as much as a new factorisation, by measured times of both.
  unsigned int cost_in_iterations() const { return cost; }

  /// Memory that this network shares with no other, nearly all of it for the factor.
  std::size_t bytes() const
  {
    return factor->bytes() +
           sizeof(double) * std::size_t(coupling->size() + of_multipliers.size() + unit_motion.size());
  }

private:
  Eigen::VectorXd solve_grains(Eigen::VectorXd forces) const;
  template <typename Columns>
  Columns solve_unconditioned(const Columns& forces) const;
  void condense();

  std::shared_ptr<const BoundaryConditions<dim>> its_conditions;
  std::shared_ptr<const BlockFactor<dim>> factor;
  std::shared_ptr<const Eigen::MatrixXd> coupling; ///< forces on grains under unit strains; [n_own × n_voigt]
  Stiffness<dim> of_strains;                       ///< volume × stiffness without motions of the grains [N m]
  Eigen::MatrixXd of_multipliers;                  ///< motions under the unit multipliers of the conditions
  Eigen::LDLT<Eigen::MatrixXd> violations_of_multipliers;
  Eigen::MatrixXd unit_motion; ///< of grains under unit strains; [n_own × n_voigt]
  Stiffness<dim> condensed;    ///< volume × stiffness [N m]
  unsigned int cost;
};
} // namespace feldspar

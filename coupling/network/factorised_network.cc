#include "coupling/network/factorised_network.h"

#include <algorithm>
#include <array>

namespace feldspar
{
template <int dim>
FactorisedNetwork<dim>::FactorisedNetwork(const std::vector<Link<dim>>& links, const std::size_t n_grains,
                                          std::shared_ptr<const BoundaryConditions<dim>> admitted,
                                          const LinkStiffnesses<dim>& stiffnesses, const Motion<dim>& regularising)
  : its_conditions(std::move(admitted))
  , of_strains(Stiffness<dim>::Zero())
{
  constexpr int n = n_motions<dim>;
  const Eigen::Index n_own = n * Eigen::Index(n_grains);
  const auto has_stiffness = [&](const std::uint32_t link) { return stiffnesses[link] != nullptr; };
  const auto made =
    std::make_shared<BlockFactor<dim>>(std::make_shared<const StiffnessPattern>(links, n_grains, has_stiffness));
  Eigen::MatrixXd of_unit_strains = Eigen::MatrixXd::Zero(n_own, n_voigt<dim>);
  for (std::uint32_t k = 0; k < links.size(); ++k)
    if (const JointStiffness<dim>* const stiffness = stiffnesses[k])
      {
        made->add(links[k], *stiffness);
        const LinkStrainGradient<dim>& by_strain = links[k].by_strain;
        const Eigen::Matrix<double, 2 * n, n_voigt<dim>> forces =
          links[k].by_grains.transpose() * (*stiffness * by_strain);
        of_unit_strains.middleRows<n>(n * Eigen::Index(links[k].grain_1)) += forces.template topRows<n>();
        of_unit_strains.middleRows<n>(n * Eigen::Index(links[k].grain_2)) += forces.template bottomRows<n>();
        of_strains += by_strain.transpose() * *stiffness * by_strain;
      }
  coupling = std::make_shared<const Eigen::MatrixXd>(std::move(of_unit_strains));
  for (std::size_t i = 0; i < n_grains; ++i)
    for (int c = 0; c < n; ++c)
      {
        const double present = made->diagonal(i, c);
        made->set_diagonal(i, c, present + (present > 0.0 ? regularising[c] : regularising[c] + 1.0));
      }
  constexpr double rigid = 1e12; // over its own stiffness
  for (const std::uint32_t grain : its_conditions->held())
    for (int c = 0; c < dim; ++c)
      made->set_diagonal(grain, c, rigid * made->diagonal(grain, c));
  made->factorise();
  factor = made;
  condense();

  // Cost of an iteration over that of a solution: an iteration also applies the matrix, and an operation of the factor,
  // whose blocks stay in the cache, is somewhat faster.
  constexpr double iteration_over_solution = 3.5;
  cost = unsigned(std::clamp(made->cost_of_factor() / iteration_over_solution, 8.0, 1000.0));
}

template <int dim>
FactorisedNetwork<dim> FactorisedNetwork<dim>::under(std::shared_ptr<const BoundaryConditions<dim>> others) const
{
  FactorisedNetwork copy = *this;
  copy.its_conditions = std::move(others);
  copy.condense();
  return copy;
}

/// The motions under unit multipliers of the boundary, and under unit strains.
template <int dim>
void FactorisedNetwork<dim>::condense()
{
  const Eigen::Index n_own = coupling->rows();
  const Eigen::Index n_multipliers = its_conditions->n_multipliers();
  of_multipliers.resize(n_own, n_multipliers);
  Eigen::MatrixXd products(n_multipliers, n_multipliers);
  for (Eigen::Index k = 0; k < n_multipliers; ++k)
    {
      Eigen::VectorXd forces = Eigen::VectorXd::Zero(n_own);
      its_conditions->add_reactions(Eigen::VectorXd::Unit(n_multipliers, k), 1.0, forces);
      of_multipliers.col(k) = solve_unconditioned(forces);
      products.col(k) = its_conditions->violations(of_multipliers.col(k));
    }
  if (n_multipliers > 0)
    violations_of_multipliers.compute(products);

  UnitUnknowns<dim> of_unit_strains =
    UnitUnknowns<dim>::Zero(n_own + n_voigt<dim>, UnitUnknowns<dim>::ColsAtCompileTime);
  of_unit_strains.topLeftCorner(n_own, n_voigt<dim>) = *coupling;
  unit_motion = -solve_with_strain_held(of_unit_strains).topLeftCorner(n_own, n_voigt<dim>);
  condensed = of_strains + coupling->transpose().lazyProduct(unit_motion); // as Equilibrium::tangent()
}

template <int dim>
template <typename Columns>
Columns FactorisedNetwork<dim>::solve_unconditioned(const Columns& forces) const
{
  constexpr int n = n_motions<dim>;
  if (!its_conditions->held().empty())
    return factor->solve(forces);
  // Forces in balance have no sum; what round-off leaves of it would shift the whole body far. A body that is held
  // carries it. A factor that was rounded shifts the body by balanced forces, too: for the inverse to be symmetric both
  // are taken out.
  const auto without_mean = [](Columns rows) {
    RowsOf<dim, Columns> mean = RowsOf<dim, Columns>::Zero();
    const Eigen::Index n_grains = rows.rows() / n;
    for (Eigen::Index i = 0; i < n_grains; ++i)
      mean += rows.template middleRows<dim>(n * i) / double(n_grains);
    for (Eigen::Index i = 0; i < n_grains; ++i)
      rows.template middleRows<dim>(n * i) -= mean;
    return rows;
  };
  return without_mean(factor->solve(without_mean(forces)));
}

template <int dim>
Eigen::VectorXd FactorisedNetwork<dim>::solve_grains(Eigen::VectorXd forces) const
{
  its_conditions->project(forces);
  Eigen::VectorXd motions = solve_unconditioned(forces);
  if (its_conditions->n_multipliers() > 0)
    motions -= of_multipliers * violations_of_multipliers.solve(its_conditions->violations(motions));
  its_conditions->project(motions);
  return motions;
}

template <int dim>
Unknowns FactorisedNetwork<dim>::solve(const Unknowns& forces,
                                       const std::array<bool, n_voigt<dim>>& strain_is_free) const
{
  const Eigen::Index n_own = unit_motion.rows();
  Unknowns result = Unknowns::Zero(forces.size());
  result.head(n_own) = solve_grains(forces.head(n_own));
  // Block elimination of the free strains.
  int n_free = 0;
  std::array<int, n_voigt<dim>> free{};
  for (int k = 0; k < n_voigt<dim>; ++k)
    if (strain_is_free[k])
      free[n_free++] = k;
  if (n_free == 0)
    return result;
  const Voigt<dim> right = forces.tail<n_voigt<dim>>() + unit_motion.transpose() * forces.head(n_own);
  Eigen::MatrixXd schur(n_free, n_free);
  Eigen::VectorXd right_free(n_free);
  for (int a = 0; a < n_free; ++a)
    {
      right_free[a] = right[free[a]];
      for (int b = 0; b < n_free; ++b)
        schur(a, b) = condensed(free[a], free[b]);
    }
  const Eigen::VectorXd strain = schur.ldlt().solve(right_free);
  for (int a = 0; a < n_free; ++a)
    {
      result[n_own + free[a]] = strain[a];
      result.head(n_own) += strain[a] * unit_motion.col(free[a]);
    }
  return result;
}

template <int dim>
UnitUnknowns<dim> FactorisedNetwork<dim>::solve_with_strain_held(const UnitUnknowns<dim>& forces) const
{
  const Eigen::Index n_own = coupling->rows();
  UnitUnknowns<dim> result = UnitUnknowns<dim>::Zero(forces.rows(), forces.cols());
  if (its_conditions->are_none())
    result.topRows(n_own) = solve_unconditioned(UnitUnknowns<dim>(forces.topRows(n_own)));
  else
    for (int k = 0; k < n_voigt<dim>; ++k)
      result.col(k).head(n_own) = solve_grains(forces.col(k).head(n_own));
  return result;
}

template class FactorisedNetwork<2>;
template class FactorisedNetwork<3>;
} // namespace feldspar

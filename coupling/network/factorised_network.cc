#include "coupling/network/factorised_network.h"

#include <Eigen/Cholesky>

#include <algorithm>
#include <array>

namespace feldspar
{
namespace
{
template <int dim>
std::array<Eigen::Index, 2> first_motions(const Link<dim>& link)
{
  return {n_motions<dim> * Eigen::Index(link.grain_1), n_motions<dim> * Eigen::Index(link.grain_2)};
}
} // namespace

template <int dim>
StiffnessPattern<dim>::StiffnessPattern(const std::vector<Link<dim>>& links, const std::size_t n_grains)
{
  constexpr int n = n_motions<dim>;
  std::vector<Eigen::Triplet<double>> neighbours;
  for (const Link<dim>& link : links)
    {
      neighbours.emplace_back(int(link.grain_1), int(link.grain_2), 1.0);
      neighbours.emplace_back(int(link.grain_2), int(link.grain_1), 1.0);
    }
  for (std::size_t i = 0; i < n_grains; ++i)
    neighbours.emplace_back(int(i), int(i), 1.0);
  Eigen::SparseMatrix<double> graph{Eigen::Index(n_grains), Eigen::Index(n_grains)};
  graph.setFromTriplets(neighbours.begin(), neighbours.end());
  Eigen::PermutationMatrix<Eigen::Dynamic, Eigen::Dynamic, int> order;
  Eigen::AMDOrdering<int>()(graph, order);

  row_of_motion.resize(n * Eigen::Index(n_grains));
  for (Eigen::Index k = 0; k < Eigen::Index(n_grains); ++k)
    for (int c = 0; c < n; ++c)
      row_of_motion[n * Eigen::Index(order.indices()[k]) + c] = int(n * k + c);

  std::vector<Eigen::Triplet<double>> entries;
  for (Eigen::Index i = 0; i < row_of_motion.size(); ++i)
    entries.emplace_back(int(i), int(i), 0.0);
  const auto for_each_entry = [&](const Link<dim>& link, const auto& visit) {
    const auto first = first_motions(link);
    for (int c = 0; c < 2 * n; ++c)
      for (int r = 0; r < 2 * n; ++r)
        {
          const int row = row_of_motion[first[r / n] + r % n];
          const int column = row_of_motion[first[c / n] + c % n];
          if (row >= column)
            visit(row, column, r, c);
        }
  };
  for (const Link<dim>& link : links)
    for_each_entry(link, [&](const int row, const int column, int, int) { entries.emplace_back(row, column, 0.0); });
  lower.resize(row_of_motion.size(), row_of_motion.size());
  lower.setFromTriplets(entries.begin(), entries.end());
  lower.makeCompressed();

  first_slot.push_back(0);
  for (const Link<dim>& link : links)
    {
      for_each_entry(link, [&](const int row, const int column, const int r, const int c) {
        const int* const begin = lower.innerIndexPtr() + lower.outerIndexPtr()[column];
        const int* const end = lower.innerIndexPtr() + lower.outerIndexPtr()[column + 1];
        slots.push_back({std::uint32_t(std::lower_bound(begin, end, row) - lower.innerIndexPtr()), std::uint16_t(r),
                         std::uint16_t(c)});
      });
      first_slot.push_back(std::uint32_t(slots.size()));
    }
}

template <int dim>
void StiffnessPattern<dim>::add(const std::vector<Link<dim>>& links, const std::size_t link,
                                const JointStiffness<dim>& stiffness, Eigen::SparseMatrix<double>& sum) const
{
  const LinkGradient<dim>& gradient = links[link].by_grains;
  const Eigen::Matrix<double, 2 * n_motions<dim>, 2 * n_motions<dim>> of_link =
    gradient.transpose() * (stiffness * gradient);
  double* const values = sum.valuePtr();
  for (std::uint32_t k = first_slot[link]; k < first_slot[link + 1]; ++k)
    values[slots[k].value] += of_link(slots[k].row, slots[k].column);
}

template <int dim>
FactorisedNetwork<dim>::FactorisedNetwork(const std::vector<Link<dim>>& links, const StiffnessPattern<dim>& where,
                                          std::shared_ptr<const BoundaryConditions<dim>> admitted,
                                          const StiffnessOf<dim>& stiffness_of, const Motion<dim>& lent)
  : pattern(where)
  , its_conditions(std::move(admitted))
  , of_strains(Stiffness<dim>::Zero())
{
  constexpr int n = n_motions<dim>;
  const Eigen::Index n_own = pattern.place().size();
  Eigen::SparseMatrix<double> matrix = pattern.matrix();
  Eigen::MatrixXd of_unit_strains = Eigen::MatrixXd::Zero(n_own, n_voigt<dim>);
  for (std::uint32_t k = 0; k < links.size(); ++k)
    if (const JointStiffness<dim>* const stiffness = stiffness_of(k))
      {
        pattern.add(links, k, *stiffness, matrix);
        const LinkStrainGradient<dim>& by_strain = links[k].by_strain;
        const Eigen::Matrix<double, 2 * n, n_voigt<dim>> forces =
          links[k].by_grains.transpose() * (*stiffness * by_strain);
        const auto first = first_motions(links[k]);
        for (int end = 0; end < 2; ++end)
          of_unit_strains.block<n, n_voigt<dim>>(first[end], 0) += forces.template middleRows<n>(n * end);
        of_strains += by_strain.transpose() * *stiffness * by_strain;
      }
  coupling = std::make_shared<const Eigen::MatrixXd>(std::move(of_unit_strains));
  const auto diagonal_of = [&](const Eigen::Index i) -> double& {
    return matrix.valuePtr()[matrix.outerIndexPtr()[pattern.place()[i]]]; // it leads its column
  };
  for (Eigen::Index i = 0; i < n_own; ++i)
    diagonal_of(i) += diagonal_of(i) > 0.0 ? lent[i % n] : lent[i % n] + 1.0;
  constexpr double rigid = 1e12; // over its own stiffness
  for (const std::uint32_t grain : its_conditions->held())
    for (int c = 0; c < dim; ++c)
      diagonal_of(n * Eigen::Index(grain) + c) *= rigid;
  const auto made = std::make_shared<Factor>();
  made->analyzePattern(matrix);
  made->factorize(matrix);
  factor = made;
  condense();

  // Factorising takes the squares of the columns' lengths, a solution and the rest of an iteration some ten a value.
  const auto& columns = factor->matrixL().nestedExpression();
  double squares = 0.0;
  for (Eigen::Index c = 0; c < n_own; ++c)
    {
      const double length = columns.outerIndexPtr()[c + 1] - columns.outerIndexPtr()[c];
      squares += length * length;
    }
  cost = unsigned(std::clamp(squares / (10.0 * double(columns.nonZeros())), 8.0, 1000.0));
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

  unit_motion.resize(n_own, n_voigt<dim>);
  for (int k = 0; k < n_voigt<dim>; ++k)
    unit_motion.col(k) = -solve_grains(coupling->col(k));
  condensed = of_strains + coupling->transpose() * unit_motion;
}

template <int dim>
Eigen::VectorXd FactorisedNetwork<dim>::solve_unconditioned(const Eigen::VectorXd& forces) const
{
  constexpr int n = n_motions<dim>;
  // Forces in balance have no sum; what round-off leaves of it would shift the whole body far. A body that is held bears it.
  Motion<dim> mean = Motion<dim>::Zero();
  const Eigen::Index n_grains = forces.size() / n;
  if (its_conditions->held().empty())
    for (Eigen::Index i = 0; i < n_grains; ++i)
      mean += forces.segment<n>(n * i) / double(n_grains);
  mean.template tail<n_rotations<dim>>().setZero();
  Eigen::VectorXd ordered(forces.size());
  for (Eigen::Index i = 0; i < forces.size(); ++i)
    ordered[pattern.place()[i]] = forces[i] - mean[i % n];
  ordered = factor->solve(ordered).eval();
  Eigen::VectorXd motions(forces.size());
  for (Eigen::Index i = 0; i < forces.size(); ++i)
    motions[i] = ordered[pattern.place()[i]];
  return motions;
}

template <int dim>
Eigen::VectorXd FactorisedNetwork<dim>::solve_grains(Eigen::VectorXd forces) const
{
  if (its_conditions->are_none())
    return solve_unconditioned(forces);
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

template class StiffnessPattern<2>;
template class FactorisedNetwork<2>;
template class StiffnessPattern<3>;
template class FactorisedNetwork<3>;
} // namespace feldspar

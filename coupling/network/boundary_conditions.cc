#include "coupling/network/boundary_conditions.h"

#include "dem/specimen/disjoint_sets.h"

#include <cmath>
#include <map>
#include <utility>

namespace feldspar
{
template <int dim>
BoundaryConditions<dim>::BoundaryConditions(std::vector<Piece> wanted, const bool turn_alike,
                                            std::vector<std::uint32_t> held)
  : all_pieces(std::move(wanted))
  , pairs_turn_alike(turn_alike)
  , held_grains(std::move(held))
{
  constexpr int n = n_motions<dim>;
  for (const Piece& piece : all_pieces)
    for (int c = 0; c < dim; ++c)
      {
        rows.emplace_back();
        for (const Pair& pair : piece)
          rows.back().insert(rows.back().end(), {{n * Eigen::Index(pair.image) + c, pair.share},
                                                 {n * Eigen::Index(pair.owner) + c, -pair.share}});
      }
  if (pairs_turn_alike)
    for (const Piece& piece : all_pieces)
      for (const Pair& pair : piece)
        for (int c = dim; c < n; ++c)
          rows.push_back({{n * Eigen::Index(pair.image) + c, 1.0}, {n * Eigen::Index(pair.owner) + c, -1.0}});

  Eigen::MatrixXd products = Eigen::MatrixXd::Zero(n_multipliers(), n_multipliers());
  std::map<Eigen::Index, std::vector<std::pair<Eigen::Index, double>>> columns;
  for (Eigen::Index k = 0; k < n_multipliers(); ++k)
    for (const Entry& entry : rows[std::size_t(k)])
      columns[entry.motion].emplace_back(k, entry.value);
  for (const auto& [motion, entries] : columns)
    for (const auto& [k, one] : entries)
      for (const auto& [l, other] : entries)
        products(k, l) += one * other;
  if (!rows.empty())
    gram.compute(products);
}

template <int dim>
std::vector<std::uint32_t> BoundaryConditions<dim>::grains() const
{
  std::vector<std::uint32_t> all = held_grains;
  for (const Piece& piece : all_pieces)
    for (const Pair& pair : piece)
      all.insert(all.end(), {pair.image, pair.owner});
  return all;
}

template <int dim>
BoundaryConditions<dim> BoundaryConditions<dim>::that_bear(const std::vector<Link<dim>>& links,
                                                           const std::size_t n_joints, const std::size_t n_grains,
                                                           const std::function<bool(std::uint32_t)>& holds) const
{
  DisjointSets fragments(n_grains);
  for (std::uint32_t j = 0; j < n_joints; ++j)
    if (holds(j))
      fragments.merge(links[j].grain_1, links[j].grain_2);
  std::vector<Piece> pieces_left;
  for (const Piece& piece : all_pieces)
    {
      Piece left;
      double whole = 0.0;
      for (const Pair& pair : piece)
        if (fragments.root(pair.image) == fragments.root(pair.owner))
          {
            left.push_back(pair);
            whole += std::abs(pair.share);
          }
      for (Pair& pair : left)
        pair.share /= whole;
      if (!left.empty())
        pieces_left.push_back(std::move(left));
    }
  return BoundaryConditions(std::move(pieces_left), pairs_turn_alike, held_grains);
}

template <int dim>
Eigen::VectorXd BoundaryConditions<dim>::violations(const Eigen::VectorXd& motions) const
{
  Eigen::VectorXd result = Eigen::VectorXd::Zero(n_multipliers());
  for (Eigen::Index k = 0; k < n_multipliers(); ++k)
    for (const Entry& entry : rows[std::size_t(k)])
      result[k] += entry.value * motions[entry.motion];
  return result;
}

template <int dim>
void BoundaryConditions<dim>::add_reactions(const Eigen::VectorXd& multipliers, const double factor,
                                            Eigen::VectorXd& forces) const
{
  for (Eigen::Index k = 0; k < n_multipliers(); ++k)
    for (const Entry& entry : rows[std::size_t(k)])
      forces[entry.motion] += factor * multipliers[k] * entry.value;
}

template <int dim>
Eigen::VectorXd BoundaryConditions<dim>::multipliers(const Eigen::VectorXd& forces) const
{
  return rows.empty() ? Eigen::VectorXd() : Eigen::VectorXd(gram.solve(violations(forces)));
}

template <int dim>
void BoundaryConditions<dim>::project(Eigen::VectorXd& motions_or_forces) const
{
  for (const std::uint32_t grain : held_grains)
    motions_or_forces.segment<dim>(n_motions<dim> * Eigen::Index(grain)).setZero();
  if (!rows.empty())
    add_reactions(multipliers(motions_or_forces), -1.0, motions_or_forces);
}

template class BoundaryConditions<2>;
template class BoundaryConditions<3>;
} // namespace feldspar

// The linear equations of a network with bonds and open, stick and slip states frozen; docs/theory.md §9.4.

#include "base/checksum/fingerprint.h"
#include "coupling/network/conjugate_gradients.h"
#include "coupling/rve/equilibrium.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>

namespace feldspar
{
/// Forces on grains, and volume × stress, for small motions from where the network stands: Unknowns or UnitUnknowns.
template <int dim>
template <typename Columns>
Columns Equilibrium<dim>::apply_tangent(const Columns& unknowns,
                                        JointStiffness<dim> LinkResponse<dim>::*const which) const
{
  const Balance<dim>& at = here().balance;
  const auto& links = network.links();
  Columns result = Columns::Zero(network.n_unknowns(), unknowns.cols());
  const auto add = [&](const std::uint32_t k, const JointStiffness<dim>& stiffness) {
    if (at.turns.empty())
      add_forces<dim, Columns>(links[k], stiffness * link_motion(links[k], unknowns), result);
    else
      add_forces_of_motion(links[k], at.turns[k], stiffness, unknowns, result);
  };
  for (std::uint32_t k = 0; k < network.n_joints(); ++k)
    add(k, history.is_active(k) ? at.active[history.active_number(k)].*which : network.bonded_stiffness(k));
  for (std::size_t a = 0; a < history.active().size(); ++a)
    if (const std::uint32_t k = history.active()[a].link; !links[k].has_face)
      add(k, at.active[a].*which);
  for (const auto& [k, touch] : at.touches)
    add(k, touch.*which);
  return result;
}

template <int dim>
LinkStiffnesses<dim> Equilibrium<dim>::link_tangents() const
{
  const Balance<dim>& at = here().balance;
  LinkStiffnesses<dim> tangents(network.links().size(), nullptr);
  for (std::uint32_t k = 0; k < network.n_joints(); ++k)
    tangents[k] = &network.bonded_stiffness(k);
  for (std::size_t a = 0; a < history.active().size(); ++a)
    {
      const JointStiffness<dim>& tangent = at.active[a].tangent;
      tangents[history.active()[a].link] = tangent.isZero(0.0) ? nullptr : &tangent; // of an open one, nothing
    }
  for (const auto& [k, touch] : at.touches)
    tangents[k] = &touch.tangent;
  return tangents;
}

template <int dim>
std::uint64_t Equilibrium<dim>::states_of_tangent() const
{
  const Balance<dim>& at = here().balance;
  Fingerprint print;
  const auto add = [&](const std::uint32_t link, const JointStiffness<dim>& tangent) {
    print.add(link);
    constexpr int finer_than_a_thousandth = 52 - 10; // bits
    for (const double entry : tangent.reshaped())
      print.add(std::bit_cast<std::uint64_t>(entry) >> finer_than_a_thousandth);
  };
  for (std::size_t a = 0; a < history.active().size(); ++a)
    add(history.active()[a].link, at.active[a].tangent);
  for (const auto& [k, touch] : at.touches)
    add(k, touch.tangent);
  return print.value();
}

/// The solution by conjugate gradients with some network that was factorised: the intact one at first. The present one is
/// factorised once that has cost as many iterations more as factorising does. solve_with(network, most_iterations): a
/// LinearSolution by conjugate gradients with that network.
template <int dim>
template <typename SolveWith>
auto Equilibrium<dim>::solution(const SolveWith& solve_with)
{
  if (const auto& nearby = kept.network ? *kept.network : network.factorised_intact();
      nearby.conditions() != history.conditions())
    kept.network = std::make_shared<const FactorisedNetwork<dim>>(nearby.under(history.conditions()));
  const FactorisedNetwork<dim>& old = kept.network ? *kept.network : network.factorised_intact();
  if (kept.n_more_iterations < old.cost_in_iterations())
    {
      const unsigned int left = kept.n_fresh_iterations + old.cost_in_iterations() - kept.n_more_iterations;
      if (auto found = solve_with(old, left); found.converged)
        {
          kept.n_more_iterations += found.n_iterations - std::min(found.n_iterations, kept.n_fresh_iterations);
          return found.x;
        }
    }
  kept.network = std::make_shared<const FactorisedNetwork<dim>>(
    network.factorise(link_tangents(), regularising_stiffness, history.conditions()));
  constexpr unsigned int most_iterations = 400;
  auto found = solve_with(*kept.network, most_iterations);
  kept.n_fresh_iterations = found.n_iterations;
  kept.n_more_iterations = 0;
  return found.x;
}

/// The solution, to a tolerance, with `apply`, which is near the tangent.
template <int dim>
Unknowns Equilibrium<dim>::solve(const std::function<Unknowns(const Unknowns&)>& apply, const bool symmetric,
                                 const Unknowns& right, const std::array<bool, n_voigt<dim>>& strain_is_free,
                                 const double tolerance)
{
  return solution([&](const FactorisedNetwork<dim>& with, const unsigned int most_iterations) {
    const auto precondition = [&](const Unknowns& r) { return with.solve(r, strain_is_free); };
    return symmetric ? conjugate_gradients(apply, precondition, right, tolerance, most_iterations)
                     : bi_conjugate_gradients(apply, precondition, right, tolerance, (most_iterations + 1) / 2);
  });
}

template <int dim>
Stiffness<dim> Equilibrium<dim>::tangent()
{
  constexpr int n = n_voigt<dim>;
  constexpr int n_columns = UnitUnknowns<dim>::ColsAtCompileTime;
  if (is_intact())
    return network.intact_stiffness();
  const Eigen::Index n_own = network.n_unknowns() - n;
  // The search begins with the intact network's rearrangement. The forces that this leaves unbalanced may be no more
  // than round-off: they count against the energy of the intact network under this strain.
  UnitUnknowns<dim> units = UnitUnknowns<dim>::Zero(network.n_unknowns(), n_columns);
  Eigen::Array<double, 1, n_columns> least = decltype(least)::Zero();
  for (int k = 0; k < n; ++k)
    {
      Unknowns unit = network.intact_unknowns(Voigt<dim>::Unit(k));
      history.conditions()->project(unit);
      units.col(k) = unit;
      constexpr double error_of_motions = 1e-5; // of energies, that is squared
      least[k] = error_of_motions * std::sqrt(network.volume() * network.intact_stiffness()(k, k));
    }
  const auto apply = [&](const UnitUnknowns<dim>& x) {
    UnitUnknowns<dim> y = apply_tangent(x, &LinkResponse<dim>::tangent);
    y.template bottomRows<n>().setZero();
    return y;
  };
  const UnitUnknowns<dim> right = -apply(units);
  units.topRows(n_own) +=
    solution([&](const FactorisedNetwork<dim>& with, const unsigned int most_iterations) {
      const auto precondition = [&](const UnitUnknowns<dim>& r) { return with.solve_with_strain_held(r); };
      return conjugate_gradients(apply, precondition, right, 0.0, most_iterations, least);
    }).topRows(n_own);
  const UnitUnknowns<dim> forces = apply_tangent(units, &LinkResponse<dim>::tangent);
  // The product does without Eigen's blocks, whose size is that of the processor's cache.
  const Stiffness<dim> result =
    units.template leftCols<n>().transpose().lazyProduct(forces.template leftCols<n>()) / network.volume();
  return result.template selfadjointView<Eigen::Upper>(); // to the last bit
}

template Unknowns Equilibrium<2>::apply_tangent(const Unknowns&, JointStiffness<2> LinkResponse<2>::*) const;
template Unknowns Equilibrium<3>::apply_tangent(const Unknowns&, JointStiffness<3> LinkResponse<3>::*) const;
template LinkStiffnesses<2> Equilibrium<2>::link_tangents() const;
template LinkStiffnesses<3> Equilibrium<3>::link_tangents() const;
template std::uint64_t Equilibrium<2>::states_of_tangent() const;
template std::uint64_t Equilibrium<3>::states_of_tangent() const;
template Unknowns Equilibrium<2>::solve(const std::function<Unknowns(const Unknowns&)>&, bool, const Unknowns&,
                                        const std::array<bool, 3>&, double);
template Unknowns Equilibrium<3>::solve(const std::function<Unknowns(const Unknowns&)>&, bool, const Unknowns&,
                                        const std::array<bool, 6>&, double);
template Stiffness<2> Equilibrium<2>::tangent();
template Stiffness<3> Equilibrium<3>::tangent();
} // namespace feldspar

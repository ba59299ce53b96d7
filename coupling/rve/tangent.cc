#include "coupling/rve/tangent.h"

#include "base/checksum/fingerprint.h"
#include "coupling/network/conjugate_gradients.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>

namespace feldspar
{
template <int dim, typename Columns>
Columns apply_tangent(const NetworkHistory<dim>& history, const Balance<dim>& at, const Columns& unknowns,
                      JointStiffness<dim> LinkResponse<dim>::*const which)
{
  const Network<dim>& network = history.network();
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
std::vector<JointStiffness<dim>> link_tangents(const NetworkHistory<dim>& history, const Balance<dim>& at)
{
  const Network<dim>& network = history.network();
  std::vector<JointStiffness<dim>> tangents(network.links().size(), JointStiffness<dim>::Zero());
  for (std::uint32_t k = 0; k < tangents.size(); ++k)
    if (history.is_active(k))
      tangents[k] = at.active[history.active_number(k)].tangent;
    else if (k < network.n_joints())
      tangents[k] = network.bonded_stiffness(k);
  for (const auto& [k, touch] : at.touches)
    tangents[k] = touch.tangent;
  return tangents;
}

template <int dim>
Stiffness<dim> affine_tangent(const NetworkHistory<dim>& history, const Balance<dim>& at)
{
  constexpr int n = n_voigt<dim>;
  const Network<dim>& network = history.network();
  UnitUnknowns<dim> units = UnitUnknowns<dim>::Zero(network.n_unknowns(), UnitUnknowns<dim>::ColsAtCompileTime);
  units.template bottomLeftCorner<n, n>().setIdentity();
  return apply_tangent(history, at, units).template bottomLeftCorner<n, n>() / network.volume();
}

template <int dim>
std::uint64_t states_of_tangent(const NetworkHistory<dim>& history, const Balance<dim>& at)
{
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

template <int dim>
template <typename SolveWith>
auto TangentSolver<dim>::solution(const NetworkHistory<dim>& history, const Balance<dim>& at,
                                  const SolveWith& solve_with)
{
  const Network<dim>& network = history.network();
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
  std::vector<const JointStiffness<dim>*> stiffnesses(network.links().size(), nullptr);
  for (std::uint32_t k = 0; k < network.n_joints(); ++k)
    stiffnesses[k] = &network.bonded_stiffness(k);
  for (std::size_t a = 0; a < history.active().size(); ++a)
    {
      const JointStiffness<dim>& tangent = at.active[a].tangent;
      stiffnesses[history.active()[a].link] = tangent.isZero(0.0) ? nullptr : &tangent; // of an open one, nothing
    }
  for (const auto& [k, touch] : at.touches)
    stiffnesses[k] = &touch.tangent;
  kept.network = std::make_shared<const FactorisedNetwork<dim>>(network.factorise(
    [&](const std::uint32_t link) { return stiffnesses[link]; }, regularising_stiffness, history.conditions()));
  constexpr unsigned int most_iterations = 400;
  auto found = solve_with(*kept.network, most_iterations);
  kept.n_fresh_iterations = found.n_iterations;
  kept.n_more_iterations = 0;
  return found.x;
}

template <int dim>
Unknowns TangentSolver<dim>::solve(const NetworkHistory<dim>& history, const Balance<dim>& at,
                                   const std::function<Unknowns(const Unknowns&)>& apply, const bool symmetric,
                                   const Unknowns& right, const std::array<bool, n_voigt<dim>>& strain_is_free,
                                   const double tolerance)
{
  return solution(history, at, [&](const FactorisedNetwork<dim>& with, const unsigned int most_iterations) {
    const auto precondition = [&](const Unknowns& r) { return with.solve(r, strain_is_free); };
    return symmetric ? conjugate_gradients(apply, precondition, right, tolerance, most_iterations)
                     : bi_conjugate_gradients(apply, precondition, right, tolerance, (most_iterations + 1) / 2);
  });
}

template <int dim>
Stiffness<dim> TangentSolver<dim>::tangent(const NetworkHistory<dim>& history, const Balance<dim>& at)
{
  constexpr int n = n_voigt<dim>;
  constexpr int n_columns = UnitUnknowns<dim>::ColsAtCompileTime;
  const Network<dim>& network = history.network();
  if (history.active().empty() && at.touches.empty())
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
    UnitUnknowns<dim> y = apply_tangent(history, at, x);
    y.template bottomRows<n>().setZero();
    return y;
  };
  const UnitUnknowns<dim> right = -apply(units);
  units.topRows(n_own) +=
    solution(history, at, [&](const FactorisedNetwork<dim>& with, const unsigned int most_iterations) {
      const auto precondition = [&](const UnitUnknowns<dim>& r) { return with.solve_with_strain_held(r); };
      return conjugate_gradients(apply, precondition, right, 0.0, most_iterations, least);
    }).topRows(n_own);
  const UnitUnknowns<dim> forces = apply_tangent(history, at, units);
  // The product does without Eigen's blocks, whose size is that of the processor's cache.
  const Stiffness<dim> result =
    units.template leftCols<n>().transpose().lazyProduct(forces.template leftCols<n>()) / network.volume();
  return result.template selfadjointView<Eigen::Upper>(); // to the last bit
}

template class TangentSolver<2>;
template class TangentSolver<3>;
template Unknowns apply_tangent(const NetworkHistory<2>&, const Balance<2>&, const Unknowns&,
                                JointStiffness<2> LinkResponse<2>::*);
template Unknowns apply_tangent(const NetworkHistory<3>&, const Balance<3>&, const Unknowns&,
                                JointStiffness<3> LinkResponse<3>::*);
template std::vector<JointStiffness<2>> link_tangents(const NetworkHistory<2>&, const Balance<2>&);
template std::vector<JointStiffness<3>> link_tangents(const NetworkHistory<3>&, const Balance<3>&);
template Stiffness<2> affine_tangent(const NetworkHistory<2>&, const Balance<2>&);
template Stiffness<3> affine_tangent(const NetworkHistory<3>&, const Balance<3>&);
template std::uint64_t states_of_tangent(const NetworkHistory<2>&, const Balance<2>&);
template std::uint64_t states_of_tangent(const NetworkHistory<3>&, const Balance<3>&);
} // namespace feldspar

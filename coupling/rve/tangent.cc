#include "coupling/rve/tangent.h"

#include "base/fingerprint.h"
#include "coupling/network/conjugate_gradients.h"

#include <array>
#include <bit>
#include <cmath>

namespace feldspar
{
template <int dim>
Unknowns apply_tangent(const NetworkHistory<dim>& history, const Balance<dim>& at, const Unknowns& unknowns,
                       JointStiffness<dim> LinkResponse<dim>::*const which)
{
  const Network<dim>& network = history.network();
  const auto& links = network.links();
  Unknowns result = Unknowns::Zero(network.n_unknowns());
  const auto add = [&](const std::uint32_t k, const JointStiffness<dim>& stiffness) {
    if (at.turns.empty())
      add_forces(links[k], stiffness * link_motion(links[k], unknowns), result);
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
  const Network<dim>& network = history.network();
  Stiffness<dim> result;
  for (int k = 0; k < n_voigt<dim>; ++k)
    result.col(k) =
      apply_tangent(history, at, Unknowns::Unit(network.n_unknowns(), network.n_unknowns() - n_voigt<dim> + k))
        .template tail<n_voigt<dim>>() /
      network.volume();
  return result;
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
Unknowns TangentSolver<dim>::solve(const NetworkHistory<dim>& history, const Balance<dim>& at,
                                   const std::function<Unknowns(const Unknowns&)>& apply, const bool symmetric,
                                   const Unknowns& right, const std::array<bool, n_voigt<dim>>& strain_is_free,
                                   const double tolerance, const double least)
{
  const Network<dim>& network = history.network();
  const auto solve = [&](const FactorisedNetwork<dim>& with, const unsigned int most_iterations) {
    const auto precondition = [&](const Unknowns& r) { return with.solve(r, strain_is_free); };
    return symmetric ? conjugate_gradients(apply, precondition, right, tolerance, most_iterations, least)
                     : bi_conjugate_gradients(apply, precondition, right, tolerance, (most_iterations + 1) / 2);
  };
  if (const auto& nearby = factorised ? *factorised : network.factorised_intact();
      nearby.conditions() != history.conditions())
    factorised = std::make_shared<const FactorisedNetwork<dim>>(nearby.under(history.conditions()));
  const FactorisedNetwork<dim>& old = factorised ? *factorised : network.factorised_intact();
  if (const LinearSolution solution = solve(old, old.cost_in_iterations()); solution.converged)
    return solution.x;
  std::vector<const JointStiffness<dim>*> stiffnesses(network.links().size(), nullptr);
  for (std::uint32_t k = 0; k < network.n_joints(); ++k)
    stiffnesses[k] = &network.bonded_stiffness(k);
  for (std::size_t a = 0; a < history.active().size(); ++a)
    stiffnesses[history.active()[a].link] = &at.active[a].tangent;
  for (const auto& [k, touch] : at.touches)
    stiffnesses[k] = &touch.tangent;
  factorised = std::make_shared<const FactorisedNetwork<dim>>(network.factorise(
    [&](const std::uint32_t link) { return stiffnesses[link]; }, lent_stiffness, history.conditions()));
  constexpr unsigned int most_iterations = 400;
  return solve(*factorised, most_iterations).x;
}

template <int dim>
Stiffness<dim> TangentSolver<dim>::tangent(const NetworkHistory<dim>& history, const Balance<dim>& at)
{
  const Network<dim>& network = history.network();
  if (history.active().empty() && at.touches.empty())
    return network.intact_stiffness();
  const Eigen::Index n_own = network.n_unknowns() - n_voigt<dim>;
  const auto apply = [&](const Unknowns& x) {
    Unknowns y = apply_tangent(history, at, x);
    y.template tail<n_voigt<dim>>().setZero();
    return y;
  };
  std::array<Unknowns, n_voigt<dim>> responses;
  Stiffness<dim> result;
  for (int k = 0; k < n_voigt<dim>; ++k)
    {
      // From the intact network's rearrangement on. What that leaves unbalanced may be no more than round-off: it counts
      // against the energy of the intact network under this strain.
      Unknowns& unit = responses[k];
      unit = network.intact_unknowns(Voigt<dim>::Unit(k));
      history.conditions()->project(unit);
      Unknowns right = -apply_tangent(history, at, unit);
      right.template tail<n_voigt<dim>>().setZero();
      constexpr double error_of_motions = 1e-5; // of energies, that is squared
      const double least = error_of_motions * std::sqrt(network.volume() * network.intact_stiffness()(k, k));
      unit.head(n_own) += solve(history, at, apply, true, right, {}, 0.0, least).head(n_own);
      const Unknowns forces = apply_tangent(history, at, unit);
      for (int j = 0; j <= k; ++j)
        result(j, k) = result(k, j) = responses[j].dot(forces) / network.volume();
    }
  return result;
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

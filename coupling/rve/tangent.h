#pragma once

#include "coupling/rve/network_history.h"

#include <functional>
#include <memory>
#include <vector>

/// The linear equations of a network with bonds and open, stick and slip states frozen; docs/theory.md §9.4.
namespace feldspar
{
/// Stiffness added to loose grains, over that of the intact network: no solution runs away, none is changed much.
constexpr double regularising_stiffness = 1e-7;

/// Forces on grains, and volume × stress, for small motions from where the network stands: Unknowns or UnitUnknowns.
template <int dim, typename Columns>
Columns apply_tangent(const NetworkHistory<dim>& history, const Balance<dim>& at, const Columns& unknowns,
                      JointStiffness<dim> LinkResponse<dim>::*which = &LinkResponse<dim>::tangent);

/// The stiffness of each link, in its own axes; [n_links].
template <int dim>
std::vector<JointStiffness<dim>> link_tangents(const NetworkHistory<dim>& history, const Balance<dim>& at);

/// Stress under unit strains without the grains' rearrangement [Pa].
template <int dim>
Stiffness<dim> affine_tangent(const NetworkHistory<dim>& history, const Balance<dim>& at);

/// A number for the frozen states, and for how far a face is closed to a thousandth: where it is the same, so is the
/// tangent, in finite kinematics but for what the contacts have turned since.
template <int dim>
std::uint64_t states_of_tangent(const NetworkHistory<dim>& history, const Balance<dim>& at);

/// A network that was factorised, to solve nearby ones by.
template <int dim>
struct KeptFactor
{
  std::shared_ptr<const FactorisedNetwork<dim>> network; ///< empty: the intact one
  unsigned int n_fresh_iterations = 1; ///< of the first solution by it; of the intact one as good as any
  unsigned int n_more_iterations = 0;  ///< of all later ones together, beyond as many as that
};

/// Solves the linear equations by conjugate gradients with some network that was factorised: the intact one at first. The
/// present one is factorised once that has cost as many iterations more as factorising does.
template <int dim>
class TangentSolver
{
public:
  /// Begins with what an earlier one factorised last; may be empty.
  void begin_with(KeptFactor<dim> nearby) { kept = std::move(nearby); }
  const KeptFactor<dim>& last_factorised() const { return kept; }

  /// The solution, to a tolerance, with `apply`, which is near the tangent at the balance.
  Unknowns solve(const NetworkHistory<dim>& history, const Balance<dim>& at,
                 const std::function<Unknowns(const Unknowns&)>& apply, bool symmetric, const Unknowns& right,
                 const std::array<bool, n_voigt<dim>>& strain_is_free, double tolerance);

  /// Stress under unit strains [Pa].
  Stiffness<dim> tangent(const NetworkHistory<dim>& history, const Balance<dim>& at);

private:
  /// solve_with(network, most_iterations): a LinearSolution by conjugate gradients with that network.
  template <typename SolveWith>
  auto solution(const NetworkHistory<dim>& history, const Balance<dim>& at, const SolveWith& solve_with);

  KeptFactor<dim> kept; ///< shared with the next trial, which changes nothing in it
};
} // namespace feldspar

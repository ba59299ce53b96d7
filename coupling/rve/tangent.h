#pragma once

#include "coupling/rve/network_history.h"

#include <functional>
#include <memory>
#include <vector>

/// The linear equations of a network with bonds and open, stick and slip states frozen; docs/theory.md §9.4.
namespace feldspar
{
/// Stiffness lent to what floats, over that of the intact network: no solution runs away, none is changed much.
constexpr double lent_stiffness = 1e-7;

/// Forces on grains, and volume × stress, for small motions from where the network stands.
template <int dim>
Unknowns apply_tangent(const NetworkHistory<dim>& history, const Balance<dim>& at, const Unknowns& unknowns,
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

/// Solves the linear equations by conjugate gradients with some network that was factorised: the intact one at first,
/// the present one where that takes longer than factorising it.
template <int dim>
class TangentSolver
{
public:
  /// Begins with what an earlier one factorised last; may be empty.
  void begin_with(std::shared_ptr<const FactorisedNetwork<dim>> nearby) { factorised = std::move(nearby); }
  const std::shared_ptr<const FactorisedNetwork<dim>>& last_factorised() const { return factorised; }

  /// The solution with `apply`, which is near the tangent at the balance; to a tolerance or, of one that is symmetric, until
  /// the energy of the error, as the preconditioner measures it, is at most `least` squared [√J].
  Unknowns solve(const NetworkHistory<dim>& history, const Balance<dim>& at,
                 const std::function<Unknowns(const Unknowns&)>& apply, bool symmetric, const Unknowns& right,
                 const std::array<bool, n_voigt<dim>>& strain_is_free, double tolerance, double least = 0.0);

  /// Stress under unit strains [Pa].
  Stiffness<dim> tangent(const NetworkHistory<dim>& history, const Balance<dim>& at);

private:
  /// Empty: the intact ones. Shared with the next trial, which changes nothing in it.
  std::shared_ptr<const FactorisedNetwork<dim>> factorised;
};
} // namespace feldspar

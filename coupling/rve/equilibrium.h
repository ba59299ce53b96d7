#pragma once

#include "coupling/rve/link_response.h"
#include "coupling/rve/network_state.h"
#include "coupling/rve/parameters.h"

#include <limits>
#include <memory>
#include <optional>
#include <vector>

namespace feldspar
{
/// What is prescribed, per Voigt component: a strain, or a stress.
template <int dim>
struct Control
{
  std::array<bool, n_voigt<dim>> stress_given{};
  Voigt<dim> strain = Voigt<dim>::Zero(); ///< where a strain is given; elsewhere where to begin
  Voigt<dim> stress = Voigt<dim>::Zero(); ///< where a stress is given [Pa]
};

template <int dim>
Control<dim> strain_control(const Voigt<dim>& strain)
{
  Control<dim> control;
  control.strain = strain;
  return control;
}

/// A segment beyond its strength.
struct Overload
{
  double ratio; ///< max(σ̂/σ_b, |τ|/τ_c)
  std::uint32_t segment;
  bool in_tension;
};

/// A broken segment, in the order of breaking.
template <int dim>
struct BreakEvent
{
  std::uint32_t segment;
  bool in_tension;
  double released_energy; ///< [J]
};

/// A network on its way from one equilibrium to the next: relaxes with bonds frozen, breaks what is overloaded, relaxes
/// again. No rate enters; docs/theory.md §10.3.
template <int dim>
class Equilibrium
{
public:
  Equilibrium(const Network<dim>& network, const NetworkState<dim>& state, const EquilibriumParameters& parameters);

  /// Where the search begins, instead of at the last event: the position of a state found from it.
  void begin_at(const NetworkState<dim>& nearby);

  /// What its linear systems are solved with until that takes too long; may be empty.
  void begin_with(std::shared_ptr<const FactorisedNetwork<dim>> nearby);
  const std::shared_ptr<const FactorisedNetwork<dim>>& last_factorised() const { return factorised; }

  /// Bonds frozen: unknowns at which the forces balance to `tolerance`. False if there is no equilibrium to be found;
  /// then it stands where the search ended.
  bool relax(const Control<dim>& control, double tolerance);

  /// Segments with bonds that are overloaded, and the worst ratio of all.
  std::vector<Overload> overloads() const;

  /// Of the way since the last event, taken as straight, how much is behind when the first of these is overloaded.
  double share_until(const std::vector<Overload>& overloads) const;

  /// Makes the present position the last event and breaks these.
  void break_segments(const std::vector<Overload>& overloads, std::vector<BreakEvent<dim>>& events);

  /// The state at the present position; the next event begins from it.
  NetworkState<dim> state();

  /// Strain, stress and motions at the present position, without history.
  NetworkState<dim> provisional_state() const;

  Voigt<dim> stress() const { return present.stress; }
  double unbalanced_ratio() const { return present.unbalanced_ratio; }
  double stored_energy() const { return present.stored_energy; }
  /// In each link's own axes; [n_links].
  std::vector<Motion<dim>> link_forces() const;
  /// Bonds and open, stick and slip states frozen; [n_links].
  std::vector<JointStiffness<dim>> link_tangents() const;
  const Unknowns& unknowns() const { return position; }
  unsigned int n_iterations() const { return iterations; }

  /// With bonds and open, stick and slip states frozen as they are [Pa].
  Stiffness<dim> tangent();
  /// A number for those states, and for how far a face is closed to a thousandth: where it is the same, so is the tangent.
  std::uint64_t states_of_tangent() const;
  /// The same without the grains' rearrangement [Pa].
  Stiffness<dim> affine_tangent() const;

private:
  /// Forces at a position.
  struct Balance
  {
    Unknowns forces; ///< on grains as they act, then volume × stress
    Voigt<dim> stress;
    double unbalanced_ratio = 0.0;
    double carried_stress = 0.0; ///< Σ |f| |l| / V over the links [Pa]
    double stored_energy = 0.0;
    std::vector<LinkAnswer<dim>> active;                            ///< of each active link
    std::vector<std::pair<std::uint32_t, LinkAnswer<dim>>> touches; ///< of pairs without a face that press
  };

  bool relax_by_newton(const Control<dim>& control, double tolerance);
  void relax_by_motion(const Control<dim>& control, double tolerance);
  Balance balance(const Unknowns& at) const;
  Unknowns unbalanced(const Balance& of, const Control<dim>& control) const;
  double measure(const Balance& of, const Control<dim>& control) const;
  Unknowns apply_tangent(const Balance& at, const Unknowns& unknowns,
                         JointStiffness<dim> LinkAnswer<dim>::*which = &LinkAnswer<dim>::tangent) const;
  template <typename Apply>
  Unknowns solve_linear(const Apply& apply, bool symmetric, const Unknowns& right,
                        const std::array<bool, n_voigt<dim>>& strain_is_free, double tolerance);
  ActiveLink<dim> activate(std::uint32_t link) const;
  double slip_energy(const Balance& from, const Balance& to) const;
  NetworkWork work_since_event(unsigned int n_intervals) const;
  void commit();
  void make_event(); ///< of the present position; nothing breaks

  const Network<dim>& network;
  EquilibriumParameters parameters;
  std::vector<ActiveLink<dim>> active;      ///< in the order of their first break or touch
  std::vector<std::uint32_t> active_number; ///< of each link in `active`, or none
  NetworkState<dim> last;                   ///< at the last event, but for what `active` holds
  Unknowns position_at_event;
  Balance at_event;
  Unknowns position;
  Balance present;
  /// With some stiffnesses there were; empty: the intact ones. Shared with the next trial, which changes nothing in it.
  std::shared_ptr<const FactorisedNetwork<dim>> factorised;
  unsigned int iterations = 0;
};
} // namespace feldspar

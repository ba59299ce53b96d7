#pragma once

#include "coupling/rve/breaking.h"
#include "coupling/rve/relaxation.h"

#include <optional>
#include <vector>

namespace feldspar
{
/// A broken segment, in the order of breaking.
template <int dim>
struct BreakEvent
{
  std::uint32_t segment;
  bool in_tension;
  double released_energy; ///< by all of its events [J]
};

/// Forces carried by all links of a network.
template <int dim>
struct LinkForces
{
  std::vector<Motion<dim>> values;  ///< in each link's own axes, a pull between its grains positive [N, N m]; [n_links]
  std::vector<LinkTurn<dim>> turns; ///< [n_links]; empty in small strains

  /// Force on grain 1 of a link, along the axes of the network [N].
  Vector<dim> force(const Link<dim>& link, const std::size_t k) const
  {
    Vector<dim> own = values[k].template head<dim>();
    if (!turns.empty())
      own = turns[k].gradient.by_way.transpose() * own;
    return link.axes.transpose() * own;
  }
};

/// A network on its way from one equilibrium to the next: relaxes with bonds frozen, breaks what is overloaded, relaxes
/// again. No rate enters; docs/theory.md §9.3.
template <int dim>
class Equilibrium
{
public:
  Equilibrium(const Network<dim>& network, const NetworkState<dim>& state, const EquilibriumParameters& parameters);

  /// Leaves the response of the intact network; to be called before it relaxes or breaks anything. An intact network
  /// then takes the kinematics that were asked for.
  void leave_intact_response();

  /// Begins the search at the position of a state found from the last event, instead of at that event.
  void begin_at(const NetworkState<dim>& nearby);

  /// The factor by which its linear systems are solved until that takes too long.
  void begin_with(KeptFactor<dim> nearby) { solver.begin_with(std::move(nearby)); }
  const KeptFactor<dim>& last_factorised() const { return solver.last_factorised(); }

  /// relax() asks this in every iteration and throws GivenUp where it says so: the network is then of no use any more.
  void leave_when(std::function<bool()> wanted) { gives_up = std::move(wanted); }

  /// Bonds frozen: unknowns at which the forces balance to `tolerance`. False if there is no equilibrium to be found;
  /// then it stands where the search ended.
  bool relax(const Control<dim>& control, double tolerance);

  /// Segments with bonds that break where it stands.
  std::vector<Overload> overloads() const { return feldspar::overloads(history, here(), parameters); }

  /// The share of the way since the last event, taken as straight, at which the first of these is overloaded.
  double share_until(const std::vector<Overload>& overloads) const
  {
    return feldspar::share_until(overloads, history, here(), parameters);
  }

  /// Makes the present position the last event and breaks these, or lets them soften.
  void break_segments(const std::vector<Overload>& overloads, std::vector<BreakEvent<dim>>& events);

  /// The state at the present position; the next event begins from it.
  NetworkState<dim> state();

  /// Strain, stress and motions at the present position, without history.
  NetworkState<dim> provisional_state() const;

  /// Returns whether nothing has broken or softened, and nothing presses that was apart at rest; false for faces that
  /// are not linear while bonded.
  bool is_intact() const { return history.active().empty() && here().balance.touches.empty(); }

  const BoundaryConditions<dim>& conditions() const { return *history.conditions(); }
  Voigt<dim> stress() const { return here().balance.stress; }
  double unbalanced_ratio() const { return here().balance.unbalanced_ratio; }
  double stored_energy() const { return here().balance.stored_energy; }
  LinkForces<dim> link_forces() const;
  /// Bonds and open, stick and slip states frozen; [n_links].
  std::vector<JointStiffness<dim>> link_tangents() const { return feldspar::link_tangents(history, here().balance); }
  const Unknowns& unknowns() const { return present.position; }
  unsigned int n_iterations() const { return iterations; }

  /// Tangent with bonds and open, stick and slip states frozen as they are [Pa].
  Stiffness<dim> tangent() { return solver.tangent(history, here().balance); }
  /// A number for those states, and for how far a face is closed to a thousandth: where it is the same, so is the tangent.
  std::uint64_t states_of_tangent() const { return feldspar::states_of_tangent(history, here().balance); }
  /// The same without the grains' rearrangement [Pa].
  Stiffness<dim> affine_tangent() const { return feldspar::affine_tangent(history, here().balance); }

private:
  void stand_at(Unknowns position);
  const Configuration<dim>& here() const;
  void commit();
  void begin_again();
  void make_event(); ///< of the present position; nothing breaks

  const Network<dim>& network;
  EquilibriumParameters parameters;
  NetworkState<dim> last; ///< at the last event, but for what `history` holds
  NetworkHistory<dim> history;
  std::optional<Balance<dim>> at_event; ///< made where it is asked for
  mutable Configuration<dim> present;   ///< its balance is made where it is asked for; one thread has an equilibrium
  mutable bool is_balanced = false;
  TangentSolver<dim> solver;
  std::function<bool()> gives_up;
  unsigned int iterations = 0;
};
} // namespace feldspar

#pragma once

#include "coupling/rve/network_history.h"
#include "coupling/rve/parameters.h"

#include <functional>
#include <memory>
#include <optional>
#include <vector>

namespace feldspar
{
/// The prescribed value of each Voigt component: a strain, or a stress.
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
  return {.strain = strain};
}

/// A segment beyond its strength, or, where its bond softens, beyond what is left of it.
struct Overload
{
  double ratio; ///< max(σ̂/σ_b, |τ|/τ_c), or SofteningDemand::ratio
  std::uint32_t segment;
  bool in_tension;
};

/// Largest number of events of a bond until it has broken.
template <int dim>
unsigned int most_events_of_a_bond(const Network<dim>& network, const EquilibriumParameters& parameters)
{
  constexpr unsigned int at_its_ends = 2; // half a step each
  return network.softening_opening().value_or(0.0) > 0.0 ? parameters.softening_steps + at_its_ends : 1;
}

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

/// A network that was factorised, to solve nearby ones by.
template <int dim>
struct KeptFactor
{
  std::shared_ptr<const FactorisedNetwork<dim>> network; ///< empty: the intact one
  unsigned int n_fresh_iterations = 1; ///< of the first solution by it; of the intact one as good as any
  unsigned int n_more_iterations = 0;  ///< of all later ones together, beyond as many as that
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

  /// The factor by which its linear systems are solved until that takes too long; shared with the next trial, which changes
  /// nothing in it.
  void begin_with(KeptFactor<dim> nearby) { kept = std::move(nearby); }
  const KeptFactor<dim>& last_factorised() const { return kept; }

  /// relax() asks this in every iteration and throws GivenUp where it says so: the network is then of no use any more.
  void leave_when(std::function<bool()> wanted) { gives_up = std::move(wanted); }

  /// Bonds frozen: unknowns at which the forces balance to `tolerance`. False if there is no equilibrium to be found;
  /// then it stands where the search ended.
  bool relax(const Control<dim>& control, double tolerance);

  /// Segments with bonds that are overloaded where it stands, as many as break at once by the rule.
  std::vector<Overload> overloads() const;

  /// The share of the way since the last event, taken as straight, at which the first of these is overloaded.
  double share_until(const std::vector<Overload>& overloads) const;

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
  /// Bonds and open, stick and slip states frozen.
  LinkStiffnesses<dim> link_tangents() const;

  /// Tangent with bonds and open, stick and slip states frozen as they are [Pa].
  Stiffness<dim> tangent();
  /// A number for those states, and for how far a face is closed to a thousandth: where it is the same, so is the
  /// tangent, in finite kinematics but for what the contacts have turned since.
  std::uint64_t states_of_tangent() const;

private:
  void stand_at(Unknowns position);
  const Configuration<dim>& here() const;
  void commit();
  void begin_again();
  void make_event(); ///< of the present position; nothing breaks

  // In relaxation.cc: two ways to where the forces balance, from a position whose given strains are reached; docs/theory.md §9.3.
  bool relax_by_newton(const Control<dim>& control, double tolerance);
  void relax_by_motion(const Control<dim>& control, double tolerance);

  // In tangent.cc: the linear equations, with bonds and open, stick and slip states frozen; docs/theory.md §9.4.
  template <typename Columns>
  Columns apply_tangent(const Columns& unknowns, JointStiffness<dim> LinkResponse<dim>::*which) const;
  template <typename SolveWith>
  auto solution(const SolveWith& solve_with);
  Unknowns solve(const std::function<Unknowns(const Unknowns&)>& apply, bool symmetric, const Unknowns& right,
                 const std::array<bool, n_voigt<dim>>& strain_is_free, double tolerance);

  /// Stiffness added to loose grains, over that of the intact network: no solution runs away, none is changed much.
  static constexpr double regularising_stiffness = 1e-7;

  const Network<dim>& network;
  EquilibriumParameters parameters;
  NetworkState<dim> last; ///< at the last event, but for what `history` holds
  NetworkHistory<dim> history;
  std::optional<Balance<dim>> at_event; ///< made where it is asked for
  mutable Configuration<dim> present;   ///< its balance is made where it is asked for; one thread has an equilibrium
  mutable bool is_balanced = false;
  KeptFactor<dim> kept;
  std::function<bool()> gives_up;
};
} // namespace feldspar

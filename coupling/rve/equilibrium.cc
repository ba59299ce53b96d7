#include "coupling/rve/equilibrium.h"

#include <algorithm>
#include <utility>

namespace feldspar
{
namespace
{
constexpr unsigned int most_rounds = 24;       // of damped motion and Newton's method after it
constexpr unsigned int rounds_before_slip = 2; // is made history
} // namespace

template <int dim>
Equilibrium<dim>::Equilibrium(const Network<dim>& of, const NetworkState<dim>& state,
                              const EquilibriumParameters& wanted)
  : network(of)
  , parameters(wanted)
  , last(state)
  , history(of, state, wanted.kinematics)
{
  stand_at(history.position());
}

/// The stored energy of an intact network is all the work that was done on it; of the same positions the kinematics make
/// another energy, by a share of the order of the strain.
template <int dim>
void Equilibrium<dim>::leave_intact_response()
{
  if (parameters.kinematics != Kinematics::finite || history.is_finite())
    return;
  history.become_finite();
  begin_again();
  last.work.boundary = at_event->stored_energy;
}

template <int dim>
void Equilibrium<dim>::begin_at(const NetworkState<dim>& nearby)
{
  stand_at(unknowns_of(network, nearby));
}

template <int dim>
void Equilibrium<dim>::stand_at(Unknowns position)
{
  present.position = std::move(position);
  is_balanced = false;
}

template <int dim>
const Configuration<dim>& Equilibrium<dim>::here() const
{
  if (!is_balanced)
    present.balance = history.balance(present.position, std::move(present.balance));
  is_balanced = true;
  return present;
}

/// Begins again at the last event.
template <int dim>
void Equilibrium<dim>::begin_again()
{
  stand_at(history.position());
  at_event = here().balance;
}

template <int dim>
bool Equilibrium<dim>::relax(const Control<dim>& control, const double tolerance)
{
  const Eigen::Index n_own = network.n_unknowns() - n_voigt<dim>;
  Unknowns to_target = Unknowns::Zero(network.n_unknowns());
  for (int k = 0; k < n_voigt<dim>; ++k)
    if (!control.stress_given[k])
      to_target[n_own + k] = control.strain[k] - present.position[n_own + k];
  if (!to_target.allFinite() || !control.stress.allFinite())
    return false;
  // The grains follow the strain as the intact network would: the first guess, and exact while nothing is broken.
  if (!to_target.isZero())
    {
      to_target.head(n_own) = network.unit_motions() * to_target.template tail<n_voigt<dim>>();
      history.conditions()->project(to_target);
      stand_at(present.position + to_target);
    }

  const auto is_small = [&] {
    return present.position.template tail<n_voigt<dim>>().cwiseAbs().maxCoeff() <= largest_strain;
  };
  for (unsigned int round = 0;; ++round)
    {
      const Unknowns before = present.position;
      if (relax_by_newton(control, tolerance))
        return is_small();
      if (round == most_rounds)
        return false;
      stand_at(before);
      relax_by_motion(control, tolerance);
      if (!is_small()) // it flies apart
        return false;
      // With one return map for a long way, the friction of faces that close and slide by turns may leave no
      // equilibrium, only a circle about one. The loss on the way there is not undone: from here it is a short way.
      if (round % rounds_before_slip == rounds_before_slip - 1)
        make_event();
    }
}

/// The work since the last event into the energies; then the present becomes the last event.
template <int dim>
void Equilibrium<dim>::commit()
{
  if (!at_event)
    at_event = history.balance(history.position());
  const NetworkWork work = work_on_the_way(history, *at_event, here());
  last.work.boundary += work.boundary;
  last.work.settled += work.settled;
  last.work.slip += work.slip;
  history.keep(here());
}

template <int dim>
void Equilibrium<dim>::make_event()
{
  commit();
  begin_again();
}

template <int dim>
void Equilibrium<dim>::break_segments(const std::vector<Overload>& overloads, std::vector<BreakEvent<dim>>& events)
{
  commit();
  const bool softens = network.softening_opening().has_value();
  for (const Overload& overload : overloads)
    {
      const std::uint32_t link = network.link_of_segment(overload.segment);
      ActiveLink<dim>& broken = history.activate(link);
      const double stored = response(network, broken, broken.motion).stored_energy;
      const std::uint32_t i = overload.segment - network.links()[link].first_segment;
      const BondEvent event = loosen(network, broken, i, overload.in_tension, 1.0 / parameters.softening_steps);
      const double released = stored - response(network, broken, broken.motion).stored_energy - event.slip_energy;
      last.work.slip += event.slip_energy;
      last.work.released += released;
      if (!event.broke)
        continue;
      ++(event.in_tension ? last.n_tension_breaks : last.n_shear_breaks);
      events.push_back({overload.segment, event.in_tension, softens ? event.released_energy : released});
    }
  history.release_loose_pairs();
  begin_again();
}

template <int dim>
NetworkState<dim> Equilibrium<dim>::provisional_state() const
{
  NetworkState<dim> result;
  result.strain = present.position.template tail<n_voigt<dim>>();
  result.stress = here().balance.stress;
  result.intact = false;
  result.motions.assign(present.position.data(), present.position.data() + network.n_unknowns() - n_voigt<dim>);
  return result;
}

template <int dim>
NetworkState<dim> Equilibrium<dim>::state()
{
  make_event();
  NetworkState<dim> result = last;
  const Eigen::Index n_own = network.n_unknowns() - n_voigt<dim>;
  result.strain = present.position.template tail<n_voigt<dim>>();
  result.stress = here().balance.stress;
  result.intact = history.active().empty();
  result.motions.clear();
  result.unbonded.clear();
  result.softened.clear();
  result.contact_shear.clear();
  if (result.intact)
    return result;
  result.motions.assign(present.position.data(), present.position.data() + n_own);
  for (const ActiveLink<dim>& link : history.active())
    for (std::uint32_t i = 0; i < link.segments.size(); ++i)
      {
        const SegmentHistory<dim>& segment = link.segments[i];
        const std::uint32_t segment_number = network.links()[link.link].first_segment + i;
        const bool idle =
          !network.links()[link.link].has_face && segment.shear_stress == decltype(segment.shear_stress){};
        if (segment.has_softened())
          result.softened.push_back({segment_number, segment.shear_stress, segment.more});
        else if (!segment.bonded && !idle)
          result.unbonded.push_back({segment_number, segment.shear_stress});
      }
  if (!network.is_linear_while_bonded())
    {
      result.contact_shear.resize(network.n_segments());
      for (std::uint32_t link = 0; link < network.n_joints(); ++link)
        {
          const auto& segments = history.active()[history.active_number(link)].segments;
          for (std::size_t i = 0; i < segments.size(); ++i)
            result.contact_shear[network.links()[link].first_segment + i] = segments[i].shear_stress;
        }
    }
  std::ranges::sort(result.unbonded, {}, &UnbondedSegment<dim>::segment);
  std::ranges::sort(result.softened, {}, &SoftenedSegment<dim>::segment);
  return result;
}

template <int dim>
LinkForces<dim> Equilibrium<dim>::link_forces() const
{
  const auto& links = network.links();
  LinkForces<dim> all{std::vector<Motion<dim>>(links.size(), Motion<dim>::Zero()), here().balance.turns};
  for (std::uint32_t k = 0; k < links.size(); ++k)
    if (history.is_active(k))
      all.values[k] = here().balance.active[history.active_number(k)].forces;
    else if (links[k].has_face)
      all.values[k] = network.bonded_stiffness(k) * history.motion(k, present.position);
  for (const auto& [k, touch] : here().balance.touches)
    all.values[k] = touch.forces;
  return all;
}

template class Equilibrium<2>;
template class Equilibrium<3>;
} // namespace feldspar

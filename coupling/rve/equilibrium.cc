#include "coupling/rve/equilibrium.h"

#include "base/fingerprint.h"
#include "coupling/rve/conjugate_gradients.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>

namespace feldspar
{
namespace
{
constexpr std::uint32_t none = std::numeric_limits<std::uint32_t>::max();
constexpr double near_worst_share = 0.98;
constexpr double tie = 1e-9; // overloads so near each other are the same; the segment's number decides
// Stiffness lent to what floats, over that of the intact network: no solution runs away, none is changed much.
constexpr double lent_stiffness = 1e-7;
constexpr unsigned int least_work_intervals = 8; // trapezoids for the way between two events
constexpr unsigned int most_work_intervals = 512;
constexpr double work_tolerance = 1e-3; // imbalance over what was moved between two events
constexpr double least_work = 1e-8;     // below this share of what is stored nothing is refined
// Of the mean link's force nothing is asked below that at this strain: a body that has come apart balances at nothing.
constexpr double least_strain = 1e-9;
constexpr double longest_step = 0.1;           // of one iteration, over the mean branch
constexpr unsigned int most_long_steps = 40;   // then the body flies apart
constexpr unsigned int most_rounds = 24;       // of damped motion and Newton's method after it
constexpr unsigned int rounds_before_slip = 2; // is made history
} // namespace

template <int dim>
Equilibrium<dim>::Equilibrium(const Network<dim>& of, const NetworkState<dim>& state,
                              const EquilibriumParameters& wanted)
  : network(of)
  , parameters(wanted)
  , active_number(of.links().size(), none)
  , last(state)
{
  position_at_event = unknowns_of(network, state);
  for (const auto& unbonded : state.unbonded)
    {
      const std::uint32_t link = network.link_of_segment(unbonded.segment);
      if (active_number[link] == none)
        {
          active_number[link] = std::uint32_t(active.size());
          active.push_back(activate(link));
        }
      auto& segment = active[active_number[link]].segments[unbonded.segment - network.links()[link].first_segment];
      segment.bonded = false;
      segment.shear_stress = unbonded.shear_stress;
    }
  position = position_at_event;
  at_event = balance(position);
  present = at_event;
}

template <int dim>
void Equilibrium<dim>::begin_with(std::shared_ptr<const FactorisedNetwork<dim>> nearby)
{
  factorised = std::move(nearby);
}

template <int dim>
void Equilibrium<dim>::begin_at(const NetworkState<dim>& nearby)
{
  position = unknowns_of(network, nearby);
  present = balance(position);
}

/// As it stands at the last event, all bonded; a pair without a face never is.
template <int dim>
ActiveLink<dim> Equilibrium<dim>::activate(const std::uint32_t link) const
{
  const Link<dim>& of = network.links()[link];
  ActiveLink<dim> result{link, link_motion(of, position_at_event), {}};
  result.segments.resize(of.n_segments);
  result.segments.front().bonded = of.has_face;
  return result;
}

template <int dim>
typename Equilibrium<dim>::Balance Equilibrium<dim>::balance(const Unknowns& at) const
{
  const auto& links = network.links();
  Balance result;
  result.forces = Unknowns::Zero(network.n_unknowns());
  result.active.resize(active.size());
  double carried = 0.0;
  std::size_t n_carrying = 0;
  const auto add = [&](const Link<dim>& link, const Motion<dim>& forces) {
    add_forces(link, forces, result.forces);
    const double force = forces.template head<dim>().norm();
    carried += force;
    ++n_carrying;
    result.carried_stress += force * link.branch.norm() / network.volume();
  };
  const auto add_answer = [&](const Link<dim>& link, const LinkAnswer<dim>& answer) {
    add(link, answer.forces);
    result.stored_energy += answer.stored_energy;
  };
  for (std::uint32_t k = 0; k < links.size(); ++k)
    {
      const Motion<dim> motion = link_motion(links[k], at);
      if (active_number[k] != none)
        {
          auto& of_link = result.active[active_number[k]];
          of_link = answer(network, active[active_number[k]], motion);
          add_answer(links[k], of_link);
        }
      else if (links[k].has_face)
        {
          const Motion<dim> forces = network.bonded_stiffness(k) * motion;
          add(links[k], forces);
          result.stored_energy += 0.5 * motion.dot(forces);
        }
      else if (links[k].opening + motion[0] < 0.0)
        {
          result.touches.emplace_back(k, answer(network, activate(k), motion));
          add_answer(links[k], result.touches.back().second);
        }
    }
  result.stress = result.forces.template tail<n_voigt<dim>>() / network.volume();

  double largest = 0.0;
  for (std::size_t i = 0; i < network.n_grains(); ++i)
    {
      const auto force = result.forces.template segment<n_motions<dim>>(n_motions<dim> * Eigen::Index(i));
      largest = std::max({largest, force.template head<dim>().norm(),
                          force.template tail<n_rotations<dim>>().norm() / network.radii()[i]});
    }
  const double least = least_strain * network.mean_normal_stiffness();
  const double mean_force = n_carrying > 0 ? carried / double(n_carrying) : 0.0;
  result.unbalanced_ratio = largest / std::max(mean_force, least);
  result.carried_stress =
    std::max(result.carried_stress, least * double(network.n_joints()) * network.mean_branch() / network.volume());
  // Forces on grains act against the links' own.
  result.forces.head(network.n_unknowns() - n_voigt<dim>) *= -1.0;
  return result;
}

/// Forces on grains, and on the free strains what is missing of the given stress × volume.
template <int dim>
Unknowns Equilibrium<dim>::unbalanced(const Balance& of, const Control<dim>& control) const
{
  Unknowns forces = of.forces;
  for (int k = 0; k < n_voigt<dim>; ++k)
    forces[network.n_unknowns() - n_voigt<dim> + k] =
      control.stress_given[k] ? network.volume() * (control.stress[k] - of.stress[k]) : 0.0;
  return forces;
}

/// The unbalanced ratio, and for given stresses their error over what the links carry: of a body that has come apart the
/// stress itself may be nothing.
template <int dim>
double Equilibrium<dim>::measure(const Balance& of, const Control<dim>& control) const
{
  double worst = of.unbalanced_ratio;
  const double size = std::max(of.carried_stress, control.stress.norm());
  for (int k = 0; k < n_voigt<dim>; ++k)
    if (control.stress_given[k] && size > 0.0)
      worst = std::max(worst, std::abs(control.stress[k] - of.stress[k]) / size);
  return worst;
}

template <int dim>
Unknowns Equilibrium<dim>::apply_tangent(const Balance& at, const Unknowns& unknowns,
                                         JointStiffness<dim> LinkAnswer<dim>::*const which) const
{
  const auto& links = network.links();
  Unknowns result = Unknowns::Zero(network.n_unknowns());
  for (std::uint32_t k = 0; k < network.n_joints(); ++k)
    {
      const auto& stiffness =
        active_number[k] == none ? network.bonded_stiffness(k) : at.active[active_number[k]].*which;
      add_forces(links[k], stiffness * link_motion(links[k], unknowns), result);
    }
  for (std::size_t a = 0; a < active.size(); ++a)
    if (const auto& link = links[active[a].link]; !link.has_face)
      add_forces(link, at.active[a].*which * link_motion(link, unknowns), result);
  for (const auto& [k, touch] : at.touches)
    add_forces(links[k], touch.*which * link_motion(links[k], unknowns), result);
  return result;
}

/// With what was factorised last; where that takes longer than factorising anew, with the present states frozen.
template <int dim>
template <typename Apply>
Unknowns Equilibrium<dim>::solve_linear(const Apply& apply, const bool symmetric, const Unknowns& right,
                                        const std::array<bool, n_voigt<dim>>& strain_is_free, const double tolerance)
{
  const auto solve = [&](const FactorisedNetwork<dim>& with, const unsigned int most_iterations) {
    const auto precondition = [&](const Unknowns& r) { return with.solve(r, strain_is_free); };
    return symmetric ? conjugate_gradients(apply, precondition, right, tolerance, most_iterations)
                     : bi_conjugate_gradients(apply, precondition, right, tolerance, (most_iterations + 1) / 2);
  };
  const FactorisedNetwork<dim>& old = factorised ? *factorised : network.factorised_intact();
  if (const LinearSolution solution = solve(old, old.cost_in_iterations()); solution.converged)
    return solution.x;
  std::vector<const JointStiffness<dim>*> stiffnesses(network.links().size(), nullptr);
  for (std::uint32_t k = 0; k < network.n_joints(); ++k)
    stiffnesses[k] = &network.bonded_stiffness(k);
  for (std::size_t a = 0; a < active.size(); ++a)
    stiffnesses[active[a].link] = &present.active[a].tangent;
  for (const auto& [k, touch] : present.touches)
    stiffnesses[k] = &touch.tangent;
  factorised = std::make_shared<const FactorisedNetwork<dim>>(
    network.factorise([&](const std::uint32_t link) { return stiffnesses[link]; }, lent_stiffness));
  constexpr unsigned int most_iterations = 400;
  return solve(*factorised, most_iterations).x;
}

template <int dim>
bool Equilibrium<dim>::relax(const Control<dim>& control, const double tolerance)
{
  const Eigen::Index n_own = network.n_unknowns() - n_voigt<dim>;
  Unknowns to_target = Unknowns::Zero(network.n_unknowns());
  for (int k = 0; k < n_voigt<dim>; ++k)
    if (!control.stress_given[k])
      to_target[n_own + k] = control.strain[k] - position[n_own + k];
  if (!to_target.allFinite() || !control.stress.allFinite())
    return false;
  // The grains follow the strain as the intact network would: the first guess, and exact while nothing is broken.
  if (!to_target.isZero())
    {
      to_target.head(n_own) = network.unit_motions() * to_target.template tail<n_voigt<dim>>();
      position += to_target;
      present = balance(position);
    }

  const auto is_small = [&] { return position.template tail<n_voigt<dim>>().cwiseAbs().maxCoeff() <= largest_strain; };
  for (unsigned int round = 0;; ++round)
    {
      const Unknowns before = position;
      if (relax_by_newton(control, tolerance))
        return is_small();
      if (round == most_rounds)
        return false;
      position = before;
      present = balance(position);
      relax_by_motion(control, tolerance);
      if (!is_small()) // it flies apart
        return false;
      // With one return map for a long way the friction of what closes and slides by turns may leave no equilibrium, only
      // a circle about one. What was lost on the way there is lost: from here it is a short way.
      if (round % rounds_before_slip == rounds_before_slip - 1)
        make_event();
    }
}

/// Damped motion from the present position (FIRE: Bitzek et al. 2006, doi:10.1103/PhysRevLett.97.170201). Where contacts
/// open, close and slide by turns Newton's method may go in circles; what loses its energy comes nearer to rest. The mass
/// is the stiffness with all that can touch touching, so that no mode is faster than a step: with the intact one grains
/// that no joint holds had none, and flew off once they were hit.
template <int dim>
void Equilibrium<dim>::relax_by_motion(const Control<dim>& control, const double tolerance)
{
  constexpr unsigned int most_steps = 1000;
  constexpr double first_time_step = 0.3;
  constexpr double longest_time_step = 1.0; // over the inverse frequency of the stiffest modes
  constexpr double first_turn = 0.1;        // share of the velocity that is turned towards the force
  constexpr unsigned int n_steps_before_faster = 5;
  Unknowns velocity = Unknowns::Zero(network.n_unknowns());
  Unknowns momentum = velocity;
  double time_step = first_time_step;
  double turn = first_turn;
  unsigned int n_downhill = 0;
  for (unsigned int k = 0; k < most_steps && !(measure(present, control) <= tolerance); ++k)
    {
      ++iterations;
      const Unknowns force = unbalanced(present, control);
      const Unknowns acceleration = network.factorised_stiffest().solve(force, control.stress_given);
      if (force.dot(velocity) > 0.0)
        {
          const double speed = std::sqrt(velocity.dot(momentum) / acceleration.dot(force));
          velocity = (1.0 - turn) * velocity + turn * speed * acceleration;
          momentum = (1.0 - turn) * momentum + turn * speed * force;
          if (++n_downhill > n_steps_before_faster)
            {
              time_step = std::min(1.1 * time_step, longest_time_step);
              turn *= 0.99;
            }
        }
      else
        {
          velocity.setZero();
          momentum.setZero();
          n_downhill = 0;
          time_step *= 0.5;
          turn = first_turn;
        }
      velocity += time_step * acceleration;
      momentum += time_step * force;
      position += time_step * velocity;
      present = balance(position);
    }
}

template <int dim>
bool Equilibrium<dim>::relax_by_newton(const Control<dim>& control, const double tolerance)
{
  const Eigen::Index n_own = network.n_unknowns() - n_voigt<dim>;
  double error = measure(present, control);
  double step_share = 1.0;
  unsigned int n_long_steps = 0;
  // A little farther than asked, where that is to be had at once: loose grains move far, and what is left unbalanced does
  // work on all of that way.
  constexpr unsigned int most_refinements = 10;
  unsigned int n_refinements = 0;
  for (unsigned int k = 0; !(error <= 0.01 * tolerance); ++k)
    {
      if (error <= tolerance && n_refinements++ == most_refinements)
        return true;
      if (k == parameters.most_iterations)
        return error <= tolerance;
      ++iterations;
      const auto is_symmetric = [](const LinkAnswer<dim>& answer) {
        constexpr double round_off = 1e-12;
        return answer.derivative.isApprox(answer.derivative.transpose(), round_off);
      };
      const bool symmetric = std::all_of(present.active.begin(), present.active.end(), is_symmetric) &&
                             std::all_of(present.touches.begin(), present.touches.end(),
                                         [&](const auto& touch) { return is_symmetric(touch.second); });
      const Unknowns right = unbalanced(present, control);
      const auto apply = [&](const Unknowns& x) {
        Unknowns y = apply_tangent(present, x, &LinkAnswer<dim>::derivative) + lent_stiffness * network.lent(x);
        for (int c = 0; c < n_voigt<dim>; ++c)
          if (!control.stress_given[c])
            y[n_own + c] = 0.0;
        return y;
      };
      // Far from the goal contacts change more than a precise step would gain.
      const double precision = std::clamp(0.01 * tolerance / error, 1e-10, 1e-2);
      Unknowns step = step_share > 0.1 ? solve_linear(apply, symmetric, right, control.stress_given, precision)
                                       : network.factorised_stiffest().solve(right, control.stress_given);
      const double longest = longest_step * network.mean_branch();
      double largest = 0.0;
      for (std::size_t i = 0; i < network.n_grains(); ++i)
        largest = std::max(largest, step.template segment<dim>(n_motions<dim> * Eigen::Index(i)).norm());
      if (largest > longest)
        {
          if (error <= tolerance) // a loose grain: there is nothing to refine
            return true;
          if (++n_long_steps > most_long_steps)
            return false;
          step *= longest / largest;
        }

      // Contacts that open, close or slide on the way change the balance: go no farther than it gets better.
      double share = 1.0;
      Unknowns trial;
      Balance trial_balance;
      double trial_error = 0.0;
      for (; share > 0.05; share *= 0.5)
        {
          trial = position + share * step;
          trial_balance = balance(trial);
          trial_error = measure(trial_balance, control);
          if (trial_error < error)
            break;
        }
      if (error <= tolerance && !(trial_error < error))
        return true;
      step_share = trial_error < error ? 1.0 : step_share > 0.1 ? 0.05 : 1.0;
      position = trial;
      present = std::move(trial_balance);
      error = trial_error;
    }
  return true;
}

template <int dim>
std::vector<Overload> Equilibrium<dim>::overloads() const
{
  std::vector<Overload> result;
  const auto check = [&](const std::uint32_t segment, const double normal, const double shear) {
    const Strength& bond = network.strength(segment);
    const double shear_strength = std::max(0.0, bond.cohesion - network.friction_slope() * normal); // (15)
    const double in_tension = normal / bond.tensile;
    const double in_shear = shear_strength > 0.0 ? shear / shear_strength : std::numeric_limits<double>::infinity();
    if (normal > bond.tensile || shear > shear_strength)
      result.push_back({std::max(in_tension, in_shear), segment, normal > bond.tensile});
  };
  for (std::uint32_t k = 0; k < network.n_joints(); ++k)
    {
      const Link<dim>& link = network.links()[k];
      const bool is_active = active_number[k] != none;
      const Motion<dim> motion = is_active ? Motion<dim>::Zero() : link_motion(link, position);
      for (std::uint32_t i = 0; i < link.n_segments; ++i)
        {
          if (is_active)
            {
              if (!active[active_number[k]].segments[i].bonded)
                continue;
              const auto& segment = present.active[active_number[k]].segments[i];
              check(link.first_segment + i, segment.normal_stress, flat_joint::magnitude(segment.shear_stress));
            }
          else
            {
              const Vector<dim> strain = element_rows(network.elements()[i], link.half_length) * motion;
              check(link.first_segment + i, link.normal_stiffness * strain[0],
                    link.shear_stiffness * strain.template tail<dim - 1>().norm());
            }
        }
    }
  double worst = 0.0;
  for (const Overload& overload : result)
    worst = std::max(worst, overload.ratio);
  if (parameters.break_rule == BreakRule::only_worst)
    {
      // The first by number among equals.
      const auto first = std::find_if(result.begin(), result.end(),
                                      [&](const Overload& overload) { return overload.ratio >= worst * (1.0 - tie); });
      return first == result.end() ? std::vector<Overload>() : std::vector<Overload>{*first};
    }
  std::erase_if(result,
                [&](const Overload& overload) { return overload.ratio < near_worst_share * worst * (1.0 - tie); });
  return result;
}

template <int dim>
double Equilibrium<dim>::share_until(const std::vector<Overload>& overloads) const
{
  double first = 1.0;
  for (const Overload& overload : overloads)
    {
      const std::uint32_t number = network.link_of_segment(overload.segment);
      const Link<dim>& link = network.links()[number];
      const auto rows = element_rows(network.elements()[overload.segment - link.first_segment], link.half_length);
      const Vector<dim> before = rows * link_motion(link, position_at_event);
      const Vector<dim> now = rows * link_motion(link, position);
      const Strength& bond = network.strength(overload.segment);
      const auto holds = [&](const double share) {
        const Vector<dim> strain = before + share * (now - before);
        const double normal = link.normal_stiffness * strain[0];
        const double shear = link.shear_stiffness * strain.template tail<dim - 1>().norm();
        return normal <= bond.tensile && shear <= std::max(0.0, bond.cohesion - network.friction_slope() * normal);
      };
      double low = 0.0;
      double high = first;
      if (holds(high))
        continue;
      while (high - low > 1e-3 * high)
        (holds(0.5 * (low + high)) ? low : high) = 0.5 * (low + high);
      first = high;
    }
  return first;
}

/// Dissipated between two positions on the way from the last event [J].
template <int dim>
double Equilibrium<dim>::slip_energy(const Balance& from, const Balance& to) const
{
  double sum = 0.0;
  const auto add = [&](const std::uint32_t link, const LinkAnswer<dim>* before, const LinkAnswer<dim>& after) {
    for (std::uint32_t i = 0; i < after.segments.size(); ++i)
      {
        const double area = network.segment_area(network.links()[link], i);
        for (int c = 0; c < dim - 1; ++c)
          {
            const double old_stress = before ? before->segments[i].shear_stress[c] : 0.0;
            const double old_slip = before ? before->segments[i].slip[c] : 0.0;
            sum +=
              0.5 * (old_stress + after.segments[i].shear_stress[c]) * (after.segments[i].slip[c] - old_slip) * area;
          }
      }
  };
  for (std::size_t a = 0; a < active.size(); ++a)
    add(active[a].link, &from.active[a], to.active[a]);
  for (const auto& [link, touch] : to.touches)
    {
      const auto before = std::find_if(from.touches.begin(), from.touches.end(),
                                       [&, which = link](const auto& entry) { return entry.first == which; });
      add(link, before == from.touches.end() ? nullptr : &before->second, touch);
    }
  return sum;
}

/// Along the way since the last event, taken as straight, by trapezoids.
template <int dim>
NetworkWork Equilibrium<dim>::work_since_event(const unsigned int n_intervals) const
{
  const Eigen::Index n_own = network.n_unknowns() - n_voigt<dim>;
  const Unknowns way = position - position_at_event;
  NetworkWork work;
  const auto add = [&](const Balance& at, const double share) {
    work.boundary += share * network.volume() * at.stress.dot(way.template tail<n_voigt<dim>>());
    work.settled += share * at.forces.head(n_own).dot(way.head(n_own));
  };
  Balance before = at_event;
  for (unsigned int k = 1; k <= n_intervals; ++k)
    {
      Balance after = k == n_intervals ? present : balance(position_at_event + double(k) / n_intervals * way);
      add(before, 0.5 / n_intervals);
      add(after, 0.5 / n_intervals);
      work.slip += slip_energy(before, after);
      before = std::move(after);
    }
  return work;
}

/// The work since the last event into the energies; then the present becomes the last event.
template <int dim>
void Equilibrium<dim>::commit()
{
  // On a long way contacts open, close and slide: as many intervals as the balance of what was summed apart asks for.
  const auto is_fine_enough = [&](const NetworkWork& work) {
    const double stored = present.stored_energy - at_event.stored_energy;
    const double moved = std::abs(work.boundary) + std::abs(work.settled) + std::abs(work.slip) + std::abs(stored);
    return std::abs(work.boundary - work.settled - work.slip - stored) <=
           std::max(work_tolerance * moved, least_work * present.stored_energy);
  };
  unsigned int n_intervals = active.empty() ? 1 : least_work_intervals;
  NetworkWork work = work_since_event(n_intervals);
  while (!active.empty() && n_intervals < most_work_intervals && !is_fine_enough(work))
    work = work_since_event(n_intervals *= 4);
  last.work.boundary += work.boundary;
  last.work.settled += work.settled;
  last.work.slip += work.slip;

  for (std::size_t a = 0; a < active.size(); ++a)
    {
      active[a].motion = link_motion(network.links()[active[a].link], position);
      for (std::size_t i = 0; i < active[a].segments.size(); ++i)
        if (!active[a].segments[i].bonded)
          active[a].segments[i].shear_stress = present.active[a].segments[i].shear_stress;
    }
  position_at_event = position;
  for (const auto& [link, touch] : present.touches)
    {
      ActiveLink<dim> touching = activate(link);
      touching.segments.front().shear_stress = touch.segments.front().shear_stress;
      active_number[link] = std::uint32_t(active.size());
      active.push_back(std::move(touching));
    }
}

template <int dim>
void Equilibrium<dim>::make_event()
{
  commit();
  at_event = balance(position);
  present = at_event;
}

template <int dim>
void Equilibrium<dim>::break_segments(const std::vector<Overload>& overloads, std::vector<BreakEvent<dim>>& events)
{
  commit();
  for (const Overload& overload : overloads)
    {
      const std::uint32_t link = network.link_of_segment(overload.segment);
      if (active_number[link] == none)
        {
          active_number[link] = std::uint32_t(active.size());
          active.push_back(activate(link));
        }
      ActiveLink<dim>& broken = active[active_number[link]];
      const double stored = answer(network, broken, broken.motion).stored_energy;
      SegmentHistory<dim>& segment = broken.segments[overload.segment - network.links()[link].first_segment];
      segment.bonded = false;
      segment.shear_stress = {};
      const double released = stored - answer(network, broken, broken.motion).stored_energy;
      last.work.released += released;
      ++(overload.in_tension ? last.n_tension_breaks : last.n_shear_breaks);
      events.push_back({overload.segment, overload.in_tension, released});
    }
  at_event = balance(position);
  present = at_event;
}

template <int dim>
NetworkState<dim> Equilibrium<dim>::provisional_state() const
{
  NetworkState<dim> result;
  result.strain = position.template tail<n_voigt<dim>>();
  result.stress = present.stress;
  result.intact = false;
  result.motions.assign(position.data(), position.data() + network.n_unknowns() - n_voigt<dim>);
  return result;
}

template <int dim>
NetworkState<dim> Equilibrium<dim>::state()
{
  make_event();
  NetworkState<dim> result = last;
  const Eigen::Index n_own = network.n_unknowns() - n_voigt<dim>;
  result.strain = position.template tail<n_voigt<dim>>();
  result.stress = present.stress;
  result.intact = active.empty();
  result.motions.clear();
  result.unbonded.clear();
  if (result.intact)
    return result;
  result.motions.assign(position.data(), position.data() + n_own);
  for (const ActiveLink<dim>& link : active)
    for (std::uint32_t i = 0; i < link.segments.size(); ++i)
      if (!link.segments[i].bonded)
        {
          const bool idle = !network.links()[link.link].has_face &&
                            link.segments[i].shear_stress == decltype(link.segments[i].shear_stress){};
          if (!idle)
            result.unbonded.push_back({network.links()[link.link].first_segment + i, link.segments[i].shear_stress});
        }
  std::sort(result.unbonded.begin(), result.unbonded.end(),
            [](const auto& a, const auto& b) { return a.segment < b.segment; });
  return result;
}

template <int dim>
std::vector<Motion<dim>> Equilibrium<dim>::link_forces() const
{
  const auto& links = network.links();
  std::vector<Motion<dim>> forces(links.size(), Motion<dim>::Zero());
  for (std::uint32_t k = 0; k < links.size(); ++k)
    if (active_number[k] != none)
      forces[k] = present.active[active_number[k]].forces;
    else if (links[k].has_face)
      forces[k] = network.bonded_stiffness(k) * link_motion(links[k], position);
  for (const auto& [k, touch] : present.touches)
    forces[k] = touch.forces;
  return forces;
}

template <int dim>
std::vector<JointStiffness<dim>> Equilibrium<dim>::link_tangents() const
{
  std::vector<JointStiffness<dim>> tangents(network.links().size(), JointStiffness<dim>::Zero());
  for (std::uint32_t k = 0; k < tangents.size(); ++k)
    if (active_number[k] != none)
      tangents[k] = present.active[active_number[k]].tangent;
    else if (k < network.n_joints())
      tangents[k] = network.bonded_stiffness(k);
  for (const auto& [k, touch] : present.touches)
    tangents[k] = touch.tangent;
  return tangents;
}

template <int dim>
Stiffness<dim> Equilibrium<dim>::affine_tangent() const
{
  Stiffness<dim> result;
  for (int k = 0; k < n_voigt<dim>; ++k)
    result.col(k) =
      apply_tangent(present, Unknowns::Unit(network.n_unknowns(), network.n_unknowns() - n_voigt<dim> + k))
        .template tail<n_voigt<dim>>() /
      network.volume();
  return result;
}

template <int dim>
Stiffness<dim> Equilibrium<dim>::tangent()
{
  if (active.empty() && present.touches.empty())
    return network.intact_stiffness();
  const Eigen::Index n_own = network.n_unknowns() - n_voigt<dim>;
  const auto apply = [&](const Unknowns& x) {
    Unknowns y = apply_tangent(present, x);
    y.template tail<n_voigt<dim>>().setZero();
    return y;
  };
  std::array<Unknowns, n_voigt<dim>> answers;
  Stiffness<dim> result;
  for (int k = 0; k < n_voigt<dim>; ++k)
    {
      // From the intact network's rearrangement on. What that leaves unbalanced may be no more than round-off: it counts
      // against what the affine motion would leave.
      Unknowns& unit = answers[k];
      unit = network.intact_unknowns(Voigt<dim>::Unit(k));
      const auto left_by = [&](const Unknowns& motions) {
        Unknowns right = -apply_tangent(present, motions);
        right.template tail<n_voigt<dim>>().setZero();
        return right;
      };
      const auto size = [&](const Unknowns& forces) {
        return std::sqrt(forces.dot(network.factorised_intact().solve(forces, {})));
      };
      const Unknowns right = left_by(unit);
      const Unknowns affine = left_by(Unknowns::Unit(network.n_unknowns(), n_own + k));
      constexpr double error_of_motions = 1e-5; // of energies, that is squared
      const double tolerance = error_of_motions * size(affine) / std::max(size(right), 1e-300);
      if (tolerance < 1.0)
        unit.head(n_own) += solve_linear(apply, true, right, {}, tolerance).head(n_own);
      const Unknowns forces = apply_tangent(present, unit);
      for (int j = 0; j <= k; ++j)
        result(j, k) = result(k, j) = answers[j].dot(forces) / network.volume();
    }
  return result;
}

template <int dim>
std::uint64_t Equilibrium<dim>::states_of_tangent() const
{
  Fingerprint print;
  const auto add = [&](const std::uint32_t link, const JointStiffness<dim>& tangent) {
    print.add(link);
    constexpr int finer_than_a_thousandth = 52 - 10; // bits
    for (const double entry : tangent.reshaped())
      print.add(std::bit_cast<std::uint64_t>(entry) >> finer_than_a_thousandth);
  };
  for (std::size_t a = 0; a < active.size(); ++a)
    add(active[a].link, present.active[a].tangent);
  for (const auto& [k, touch] : present.touches)
    add(k, touch.tangent);
  return print.value();
}

template class Equilibrium<2>;
template class Equilibrium<3>;
} // namespace feldspar

// Two ways to where the forces of a network balance, bonds frozen; docs/theory.md §9.3.

#include "base/parallel.h"
#include "coupling/rve/equilibrium.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace feldspar
{
namespace
{
constexpr double longest_step = 0.1;         // of one iteration, over the mean branch
constexpr unsigned int most_long_steps = 40; // then the body flies apart

/// Forces on grains, and on the free strains what is missing of the given stress × volume.
template <int dim>
Unknowns unbalanced(const Network<dim>& network, const Balance<dim>& of, const Control<dim>& control)
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
double measure(const Balance<dim>& of, const Control<dim>& control)
{
  double worst = of.unbalanced_ratio;
  const double size = std::max(of.carried_stress, control.stress.norm());
  for (int k = 0; k < n_voigt<dim>; ++k)
    if (control.stress_given[k] && size > 0.0)
      worst = std::max(worst, std::abs(control.stress[k] - of.stress[k]) / size);
  return worst;
}
} // namespace

/// Damped motion from the present position (FIRE: Bitzek et al. 2006, doi:10.1103/PhysRevLett.97.170201). Where contacts
/// open, close and slide by turns Newton's method may go in circles; what loses its energy comes nearer to rest. The mass
/// is the stiffness with all possible contacts closed, so that no mode is faster than a step: with the intact one
/// grains that no joint holds had none, and flew off once they were hit.
template <int dim>
void Equilibrium<dim>::relax_by_motion(const Control<dim>& control, const double tolerance)
{
  here();
  Balance<dim>& balance = present.balance;
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
  for (unsigned int k = 0; k < most_steps && !(measure(balance, control) <= tolerance); ++k)
    {
      leave_if(gives_up);
      const Unknowns force = unbalanced(network, balance, control);
      const Unknowns acceleration = history.factorised_stiffest().solve(force, control.stress_given);
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
      present.position += time_step * velocity;
      balance = history.balance(present.position, std::move(balance));
    }
}

template <int dim>
bool Equilibrium<dim>::relax_by_newton(const Control<dim>& control, const double tolerance)
{
  here();
  Balance<dim>& balance = present.balance;
  const Eigen::Index n_own = network.n_unknowns() - n_voigt<dim>;
  double error = measure(balance, control);
  double step_share = 1.0;
  unsigned int n_long_steps = 0;
  // A little farther than asked, where that is to be had at once: loose grains move far, and what is left unbalanced does
  // work on all of that way.
  constexpr unsigned int most_refinements = 10;
  unsigned int n_refinements = 0;
  Unknowns trial;
  Balance<dim> trial_balance;
  for (unsigned int k = 0; !(error <= 0.01 * tolerance); ++k)
    {
      if (error <= tolerance && n_refinements++ == most_refinements)
        return true;
      if (k == parameters.most_iterations)
        return error <= tolerance;
      leave_if(gives_up);
      const auto is_symmetric = [](const LinkResponse<dim>& response) {
        constexpr double round_off = 1e-12;
        return response.derivative.isApprox(response.derivative.transpose(), round_off);
      };
      const bool symmetric =
        std::ranges::all_of(balance.active, is_symmetric) &&
        std::ranges::all_of(balance.touches, [&](const auto& touch) { return is_symmetric(touch.second); });
      const Unknowns right = unbalanced(network, balance, control);
      const auto apply = [&](const Unknowns& x) {
        Unknowns y =
          apply_tangent(x, &LinkResponse<dim>::derivative) + regularising_stiffness * network.regularising_forces(x);
        for (int c = 0; c < n_voigt<dim>; ++c)
          if (!control.stress_given[c])
            y[n_own + c] = 0.0;
        return y;
      };
      // Far from the goal contacts change more than a precise step would gain.
      const double precision = std::clamp(0.01 * tolerance / error, 1e-10, 1e-2);
      Unknowns step = step_share > 0.1 ? solve(apply, symmetric, right, control.stress_given, precision)
                                       : history.factorised_stiffest().solve(right, control.stress_given);
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
      double trial_error = 0.0;
      for (; share > 0.05; share *= 0.5)
        {
          trial = present.position + share * step;
          trial_balance = history.balance(trial, std::move(trial_balance));
          trial_error = measure(trial_balance, control);
          if (trial_error < error)
            break;
        }
      if (error <= tolerance && !(trial_error < error))
        return true;
      step_share = trial_error < error ? 1.0 : step_share > 0.1 ? 0.05 : 1.0;
      present.position.swap(trial);
      std::swap(balance, trial_balance);
      error = trial_error;
    }
  return true;
}

template bool Equilibrium<2>::relax_by_newton(const Control<2>&, double);
template bool Equilibrium<3>::relax_by_newton(const Control<3>&, double);
template void Equilibrium<2>::relax_by_motion(const Control<2>&, double);
template void Equilibrium<3>::relax_by_motion(const Control<3>&, double);
} // namespace feldspar

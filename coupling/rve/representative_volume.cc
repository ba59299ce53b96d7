#include "coupling/rve/representative_volume.h"

#include <Eigen/LU>

#include <algorithm>

namespace feldspar
{
template <int dim>
RepresentativeVolume<dim>::RepresentativeVolume(std::shared_ptr<const Network<dim>> network,
                                                const EquilibriumParameters& wanted)
  : reference(std::move(network))
  , parameters(wanted)
{
  for (const std::uint32_t segment : reference->unbonded())
    current.unbonded.push_back({segment, {}});
  current.intact = current.unbonded.empty();
}

template <int dim>
Voigt<dim> RepresentativeVolume<dim>::intact_strain(const Control<dim>& control) const
{
  if (std::ranges::none_of(control.stress_given, std::identity()))
    return control.strain;
  // Rows of given stresses: C_0 ε = σ; of given strains: ε itself.
  Stiffness<dim> matrix = Stiffness<dim>::Identity();
  Voigt<dim> right = control.strain;
  for (int k = 0; k < n_voigt<dim>; ++k)
    if (control.stress_given[k])
      {
        matrix.row(k) = reference->intact_stiffness().row(k);
        right[k] = control.stress[k];
      }
  return matrix.partialPivLu().solve(right);
}

template <int dim>
Trial<dim> RepresentativeVolume<dim>::intact_trial(const Voigt<dim>& strain, const bool with_tangent) const
{
  Trial<dim> trial;
  trial.state = current;
  trial.state.strain = strain;
  trial.state.stress = reference->intact_stiffness() * strain;
  trial.state.work.boundary = 0.5 * reference->volume() * strain.dot(trial.state.stress); // no loss so far
  if (with_tangent)
    trial.tangent = {0, reference->intact_stiffness()};
  return trial;
}

template <int dim>
Trial<dim> RepresentativeVolume<dim>::trial(const Control<dim>& control, const TrialOptions<dim>& options) const
{
  bool may_break = options.bonds != Bonds::frozen;
  if (current.intact)
    if (const Voigt<dim> strain = intact_strain(control);
        may_break ? reference->stays_intact(strain) : reference->stays_linear(strain))
      return intact_trial(strain, options.with_tangent);

  Trial<dim> trial;
  Equilibrium<dim> equilibrium(*reference, current, parameters);
  equilibrium.leave_intact_response();
  if (options.nearby)
    equilibrium.begin_at(*options.nearby);
  equilibrium.begin_with(options.factorised);
  equilibrium.leave_when(options.gives_up);
  for (;;)
    {
      trial.in_equilibrium = equilibrium.relax(control, parameters.event_tolerance);
      auto overloads = may_break && trial.in_equilibrium ? equilibrium.overloads() : std::vector<Overload>();
      if (overloads.empty() && trial.in_equilibrium)
        {
          trial.in_equilibrium = equilibrium.relax(control, options.share_of_tolerance * parameters.final_tolerance);
          if (may_break && trial.in_equilibrium)
            overloads = equilibrium.overloads();
        }
      if (overloads.empty())
        break;
      if (trial.n_loosened == 0)
        trial.share_until_break = equilibrium.share_until(overloads);
      trial.would_break = options.bonds == Bonds::until_break;
      if (trial.would_break)
        return trial;
      equilibrium.break_segments(overloads, trial.breaks);
      trial.n_loosened += overloads.size();
      may_break = options.bonds != Bonds::break_once;
    }
  // A network responds as the intact one until something has happened, also where bonds hold only because contacts
  // turn.
  if (current.intact && trial.in_equilibrium && equilibrium.is_intact())
    {
      Trial<dim> intact = intact_trial(intact_strain(control), options.with_tangent);
      intact.factorised = equilibrium.last_factorised();
      return intact;
    }
  if (options.with_tangent && trial.in_equilibrium)
    {
      const std::uint64_t states = equilibrium.states_of_tangent();
      const bool known = options.tangent && options.tangent->states == states;
      trial.tangent = {states, known ? options.tangent->value : equilibrium.tangent()};
    }
  trial.unbalanced_ratio = equilibrium.unbalanced_ratio();
  trial.factorised = equilibrium.last_factorised();
  trial.state = options.provisional ? equilibrium.provisional_state() : equilibrium.state();
  return trial;
}

template <int dim>
double RepresentativeVolume<dim>::stored_energy() const
{
  if (current.intact)
    return 0.5 * reference->volume() * current.strain.dot(current.stress);
  return Equilibrium<dim>(*reference, current, parameters).stored_energy();
}

template class RepresentativeVolume<2>;
template class RepresentativeVolume<3>;
} // namespace feldspar

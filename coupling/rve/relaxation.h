#pragma once

#include "coupling/rve/parameters.h"
#include "coupling/rve/tangent.h"

#include <functional>

/// Two ways to where the forces of a network balance, bonds frozen; docs/theory.md §9.3.
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
  Control<dim> control;
  control.strain = strain;
  return control;
}

/// Control, tolerance and abort of a search for equilibrium.
template <int dim>
struct Search
{
  const Control<dim>& control;
  double tolerance; ///< largest unbalanced over mean contact force
  /// Asked in every iteration; where it says so, GivenUp is thrown. Empty: never.
  const std::function<bool()>& gives_up;
};

/// State in which a search for equilibrium ended.
template <int dim>
struct Relaxed
{
  Configuration<dim> present;
  bool balanced;
  unsigned int n_iterations;
};

/// Searches by Newton's method, from a configuration whose given strains are reached. `solver` keeps its factors.
template <int dim>
Relaxed<dim> relax_by_newton(const NetworkHistory<dim>& history, Configuration<dim> from, const Search<dim>& search,
                             unsigned int most_iterations, TangentSolver<dim>& solver);

/// Searches by damped motion, which comes nearer to equilibrium where Newton's method goes in circles.
template <int dim>
Relaxed<dim> relax_by_motion(const NetworkHistory<dim>& history, Configuration<dim> from, const Search<dim>& search);
} // namespace feldspar

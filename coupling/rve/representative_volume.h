#pragma once

#include "coupling/rve/equilibrium.h"

#include <functional>
#include <memory>
#include <optional>
#include <vector>

namespace feldspar
{
/// Tangent, valid where all links are in the states it was made for.
template <int dim>
struct Tangent
{
  std::uint64_t states = 0;
  Stiffness<dim> value; ///< [Pa]
};

/// The response of a representative volume.
template <int dim>
struct Trial
{
  bool in_equilibrium = true; ///< false: nothing was found, and the rest stands where the search ended
  NetworkState<dim> state;    ///< strain, stress [Pa] and what it would keep
  std::vector<BreakEvent<dim>> breaks;
  std::size_t n_loosened = 0;          ///< bonds that broke or softened, one as often as it did
  bool would_break = false;            ///< or soften: it stands overloaded; with Bonds::until_break
  double share_until_break = 1.0;      ///< of the way from the state before, about; 1: nothing broke
  std::optional<Tangent<dim>> tangent; ///< on request
  double unbalanced_ratio = 0.0;       ///< largest unbalanced over mean contact force
  /// The factor of its last linear solution.
  KeptFactor<dim> factorised;
};

enum class Bonds
{
  may_break,
  break_once,  ///< after the first break, and those that break with it, they are frozen
  until_break, ///< as frozen, but says whether and where the first would break; then it cannot be accepted
  frozen
};

/// Options of a trial.
template <int dim>
struct TrialOptions
{
  Bonds bonds = Bonds::may_break;
  bool with_tangent = false;
  /// State at which the search begins, found by an earlier trial from the same state. Not kept.
  const NetworkState<dim>* nearby = nullptr;
  /// Only strain, stress and motions of the state are wanted, as between the iterations of a solver: it cannot be
  /// accepted.
  bool provisional = false;
  /// The factor of an earlier trial, so that none is made anew.
  KeptFactor<dim> factorised{};
  /// The tangent of an earlier trial, handed out again where the states are the same.
  std::optional<Tangent<dim>> tangent{};
  double share_of_tolerance = 1.0;  ///< of the final one, up to which the forces may stay unbalanced
  std::function<bool()> gives_up{}; ///< asked in every iteration of a search; where it says so, GivenUp is thrown
};

/// A periodic specimen that responds to a macroscopic strain with a stress; docs/theory.md §9. Copies share the reference
/// network and hold their own state only. Trying is not doing: history changes on accept().
template <int dim>
class RepresentativeVolume
{
public:
  RepresentativeVolume(std::shared_ptr<const Network<dim>> network, const EquilibriumParameters& parameters = {});

  Trial<dim> trial(const Control<dim>& control, const TrialOptions<dim>& options) const;
  Trial<dim> trial(const Control<dim>& control, const Bonds bonds = Bonds::may_break,
                   const bool with_tangent = false) const
  {
    return trial(control, {.bonds = bonds, .with_tangent = with_tangent});
  }
  Trial<dim> trial(const Voigt<dim>& strain, const Bonds bonds = Bonds::may_break,
                   const bool with_tangent = false) const
  {
    return trial(strain_control<dim>(strain), bonds, with_tangent);
  }
  void accept(Trial<dim>&& trial) { current = std::move(trial.state); }

  const NetworkState<dim>& state() const { return current; }
  void restore(NetworkState<dim> state) { current = std::move(state); }
  const Network<dim>& network() const { return *reference; }
  /// The strain at which the intact RVE would meet a control.
  Voigt<dim> intact_strain(const Control<dim>& control) const;
  /// Energy stored in the contacts [J].
  double stored_energy() const;

private:
  Trial<dim> intact_trial(const Voigt<dim>& strain, bool with_tangent) const;

  std::shared_ptr<const Network<dim>> reference; ///< shared: hundreds of RVEs refer to one network
  EquilibriumParameters parameters;
  NetworkState<dim> current;
};
} // namespace feldspar

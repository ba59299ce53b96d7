#pragma once

#include "base/voigt.h"
#include "fem/materials/forwarding_point.h"

#include <Eigen/LU>

#include <memory>
#include <optional>
#include <string>

namespace feldspar
{
/// An RVE of one size as the material of a piece of the sample of another: a band of pieces dissipates per area as the
/// RVE does, whatever their size, as long as it breaks in steps. An avalanche does not: on three meshes of a granite
/// the peaks agree within 1.5 %, the work after the peak does not; docs/theory.md §10.
///
/// Until the point localises the strain of the RVE is that of the piece. It localises where an event leaves it with
/// dσ : dε < 0 since the last accepted step. From then on the strain beyond the elastic one is scaled,
///
///     e - S_0 σ - ε_i0 = κ (ε - S_0 σ - ε_i0),        κ = size of the piece / size of the RVE,
///
/// with e the strain of the RVE, ε that of the piece, S_0 the intact compliance and ε_i0 the inelastic strain when it
/// localised. The events that follow hold this relation.
template <int dim>
class SofteningPoint final : public fem::ForwardingPoint<dim>
{
public:
  /// scale: κ in (0, 1].
  SofteningPoint(std::unique_ptr<fem::MaterialPoint<dim>> rve, double scale);

  fem::MaterialResponse<dim> trial(const Voigt<dim>& strain) const override;
  std::size_t relax(const Voigt<dim>& strain) override;
  /// All events at once: the relation holds again only where they have ended.
  fem::PointEvents<dim> relax_once(const Voigt<dim>& strain) override
  {
    const std::size_t n = relax(strain);
    return {n, trial(strain).stress};
  }
  void accept(const Voigt<dim>& strain) override;
  void reject() override;
  std::string stored() const override;
  void restore(const std::string& stored) override;
  /// The last is 1 where it has localised and since strained, beyond what is elastic, by more than it was elastically then:
  /// a break in a small RVE may let the stress fall for a moment.
  std::vector<double> fields() const override;
  std::vector<fem::PointCrack<dim>> cracks_of_last_step() const override;
  /// The energies of the piece: losses of the RVE once localised count 1/κ times. During events the piece is held and
  /// no work is done on it; the gain of its energies then is subtracted from the released energy; docs/theory.md §10.
  std::optional<fem::PointEnergies> energies() const override;

  bool has_localised() const { return at_work.localised; }
  /// The strain of the RVE in the accepted state.
  const Voigt<dim>& rve_strain() const { return accepted.rve_strain; }

private:
  struct State
  {
    Voigt<dim> strain = Voigt<dim>::Zero();
    Voigt<dim> rve_strain = Voigt<dim>::Zero();
    Voigt<dim> stress = Voigt<dim>::Zero();
    bool localised = false;
    Voigt<dim> inelastic_strain = Voigt<dim>::Zero(); ///< ε_i0
    fem::PointEnergies energies{};                    ///< of the RVE, when it localised
    double elastic_energy = 0.0;                      ///< ½ σ S_0 σ then [J/m³]
    double elastic_strain = 0.0;                      ///< |S_0 σ| then
    double gained_while_held = 0.0;                   ///< by the scaled energies of the piece in its events [J/m³]
  };
  struct Stored;

  /// A strain, where the RVE is then, and its response.
  struct Found
  {
    Voigt<dim> strain;
    Voigt<dim> rve_strain;
    fem::MaterialResponse<dim> response;
  };

  /// The RVE while the piece is held, at an event.
  struct Held
  {
    Voigt<dim> rve_strain;
    Voigt<dim> stress;
    double energy; ///< of the volume, stored and lost [J/m³]
  };

  double elastic_energy(const Voigt<dim>& stress) const { return 0.5 * stress.dot(compliance * stress); }
  double gained(const Held& first, const Held& last, const Found& now) const;
  const Found& find(const Voigt<dim>& strain) const;
  Voigt<dim> residual(const Voigt<dim>& strain, const Voigt<dim>& rve_strain, const Voigt<dim>& stress) const;
  /// ∂residual/∂(strain of the RVE).
  Stiffness<dim> gradient(const Stiffness<dim>& tangent) const
  {
    return Stiffness<dim>::Identity() - (1.0 - scale) * compliance * tangent;
  }
  void check_localisation(const Voigt<dim>& strain, const Voigt<dim>& stress);

  using fem::ForwardingPoint<dim>::inner;
  double scale;
  Stiffness<dim> compliance; ///< S_0 [1/Pa]
  State accepted;
  State at_work;                                  ///< but for strains and stress, which are those of the accepted one
  mutable std::optional<Found> found;             ///< with the structure at work
  mutable Voigt<dim> nearby = Voigt<dim>::Zero(); ///< where the search for a strain of the RVE begins
};

/// The RVEs of a material, of this size [m], at points whose elements may be smaller. Elements that are larger are
/// taken to be as large.
template <int dim>
fem::Material<dim> scaled_softening(const fem::Material<dim>& rves, double size);
} // namespace feldspar

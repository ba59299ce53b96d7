#pragma once

#include "coupling/rve/representative_volume.h"
#include "coupling/sample/realisation.h"
#include "fem/materials/material.h"

#include <any>
#include <cstdint>
#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

/// The law made of grains: a representative volume at every point of a sample; docs/theory.md §10.
namespace feldspar
{
/// The structure of a point is a GrainStructure.
template <int dim>
class GrainPoint final : public fem::MaterialPoint<dim>
{
public:
  /// orientation: turns the axes of the RVE into those of the sample. gives_up: asked in every iteration of trial() and
  /// relax(), which throw GivenUp where it says so; then only reject() is of use. keeps_factors: from one trial of a step to
  /// the next (FactorisedNetwork::bytes()).
  GrainPoint(std::shared_ptr<const Network<dim>> network, const Tensor<dim>& orientation,
             const EquilibriumParameters& parameters, std::function<bool()> gives_up = {}, bool keeps_factors = true);

  fem::MaterialResponse<dim> trial(const Voigt<dim>& strain) const override;
  std::size_t relax(const Voigt<dim>& strain) override { return relax(strain, Bonds::may_break).n; }
  fem::PointEvents<dim> relax_once(const Voigt<dim>& strain) override { return relax(strain, Bonds::break_once); }
  void accept(const Voigt<dim>& strain) override;
  void reject() override;
  std::string stored() const override;
  void restore(const std::string& stored) override;
  std::vector<double> fields() const override;
  std::optional<fem::PointEnergies> energies() const override;
  std::vector<fem::PointCrack<dim>> cracks_of_last_step() const override;
  /// Returns whether a bond has broken or softened; for a law that is not linear while it holds: whether one has
  /// broken.
  bool is_damaged() const override
  {
    const NetworkState<dim>& state = accepted.state();
    return !state.intact && (accepted.network().is_linear_while_bonded() || !state.unbonded.empty());
  }
  std::any structure() const override;

  /// The RVE in its accepted state, in its own axes.
  const RepresentativeVolume<dim>& rve() const { return accepted; }
  const Tensor<dim>& orientation() const { return turn; }

private:
  fem::PointEvents<dim> relax(const Voigt<dim>& strain, Bonds bonds);
  Trial<dim> tried_at_work(const Voigt<dim>& strain, TrialOptions<dim> options) const;
  void forget_trial();

  Tensor<dim> turn;
  Stiffness<dim> strain_to_rve; ///< Voigt strain of the sample's axes to that of the RVE's
  RepresentativeVolume<dim> accepted;
  RepresentativeVolume<dim> at_work; ///< with what broke in this step
  std::function<bool()> gives_up;
  bool keeps_factors;
  std::vector<BreakEvent<dim>> events_at_work;
  std::vector<BreakEvent<dim>> events_accepted;
  mutable std::optional<Voigt<dim>> tried_strain; ///< in the RVE's axes; of which `tried` is the response
  mutable Trial<dim> tried;
  mutable KeptFactor<dim> factorised;                      ///< in this step, by the trial that did it last
  mutable std::optional<Tangent<dim>> last_tangent;        ///< in the RVE's axes
  std::optional<Tangent<dim>> accepted_tangent;            ///< the last of the accepted state
  std::optional<std::pair<Voigt<dim>, Trial<dim>>> stable; ///< at a strain in the RVE's axes: nothing breaks there
};

struct GrainMaterialParameters
{
  std::uint64_t seed = 1;           ///< of the assignment
  bool random_orientation = true;   ///< each RVE turned by an angle of its own
  bool to_elements = false;         ///< the points of an element have the same RVE, turned alike
  bool without_replacement = false; ///< no realisation is used twice before all are; else with replacement
  unsigned int n_points_of_cell = 1;
  bool in_local_axes = false; ///< in space: what would be x, y, z is r, θ, z of the point about the axis x = y = 0
  EquilibriumParameters equilibrium;
  std::function<bool()> gives_up = {}; ///< as of GrainPoint
  bool keeps_factors = true;           ///< the same
};

/// The same packing with bonds of this share of their strengths.
template <int dim>
Specimen<dim> weakened(Specimen<dim> specimen, double share);

/// Names of rocks, as Realisation::rock, by the cells (PointPlace::cell) that consist of them.
using RocksOfCells = std::map<std::string, std::string>;

/// RVEs of these realisations assigned to the points of a sample, each point by itself from the seed: the same for any
/// number of ranks. Edges are not turned by chance: their first axis is the normal of the side. The material's fields are those of GrainPoint::fields().
template <int dim>
fem::Material<dim> grain_material(std::vector<Realisation<dim>> realisations, const GrainMaterialParameters& parameters,
                                  RocksOfCells rocks = {});
} // namespace feldspar

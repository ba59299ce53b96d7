#pragma once

#include "coupling/rve/parameters.h"
#include "coupling/sample/continua/parameters.h"
#include "coupling/sample/realisation.h"
#include "coupling/sample/sample_parameters.h"
#include "fem/output.h"
#include "fem/solid/solid.h"
#include "laboratory/record.h"

#include <array>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <variant>
#include <vector>

/// The finite elements of a sample, in whatever dimension: what a test on it asks of them.
namespace feldspar
{
/// A body between platens, as a test sees it.
struct SampleSetUp
{
  std::function<void(const fem::NewtonReport&)> watch; ///< as SolidParameters::watch
  std::function<bool()> gives_up;                      ///< as SolidParameters::gives_up
};

/// The displacement or stress to which a sample is loaded.
struct SampleTarget
{
  enum class Lead
  {
    platens,       ///< to a displacement of the top [m]
    stress,        ///< held by the platens, compression positive [Pa]
    lateral_strain ///< of the body, the platens as near as that takes
  };

  Lead lead = Lead::platens;
  double target = 0.0;
  double confining_pressure = 0.0; ///< [Pa], compression positive
};

/// Broken segments, and the event of each point that has some, with the number of the point (`joint` of the cracks).
struct PointBreaks
{
  std::vector<Crack> cracks;
  std::vector<EmissionEvent> events;
};

/// A sample between platens, its sides under a confining pressure. It changes on accept() only, and every query is
/// about the accepted state.
class SampleBody
{
public:
  virtual ~SampleBody() = default;

  /// A fraction of the way to a target.
  virtual fem::NewtonReport solve(const SampleTarget& target, double fraction) = 0;
  /// Makes the force of the top platen a stress that holds it, from which a solution for a stress goes on.
  virtual void let_force_hold_platen() = 0;
  virtual void accept() = 0;
  virtual void reject() = 0;
  virtual void limit_events(std::uint64_t most_events) = 0;

  virtual SampleSize size() const = 0;
  virtual std::array<double, 3> box() const = 0; ///< as TestRecord::size
  virtual std::uint64_t n_points() const = 0;
  virtual std::uint64_t n_segments() const = 0; ///< of the RVEs at all points
  virtual std::size_t n_points_per_cell() const = 0;
  virtual const std::vector<MineralShare>& minerals() const = 0; ///< of the RVEs; none without grains

  virtual double top_displacement() const = 0; ///< [m]
  /// Mean over the directions that are free to widen, by the volume between the sides at rest and as they are displaced.
  virtual double lateral_strain() const = 0;
  virtual double n_lateral_directions() const = 0;
  virtual double platen_stress(
    const std::string& end) const = 0;          ///< its force along the axis over its area at rest [Pa]
  virtual double mean_axial_stress() const = 0; ///< over the volume [Pa]

  virtual PointBreaks breaks_of_last_step() const = 0; ///< at points of this rank; without step and strain
  virtual Energies energies() const = 0;               ///< NaN where the material does not know them
  virtual std::uint64_t n_damaged_points() const = 0;
  /// RVE of a point; none where the point is another rank's. Throws InputError where it has no grains.
  virtual std::optional<std::variant<SampleRve<2>, SampleRve<3>>> rve(std::uint64_t point) const = 0;

  virtual void write_fields(fem::FieldOutput& output, double time) const = 0;
  virtual std::vector<std::string> boundaries() const = 0;
  virtual fem::Balance rebalance() = 0; ///< as Solid's
  virtual fem::StoredSolid stored() const = 0;
  /// Throws std::invalid_argument where it is of another mesh.
  virtual void restore(const fem::StoredSolid& stored) = 0;
};

/// Rock of the cells of the weak seed.
inline constexpr const char* rock_of_weak_seed = "weak seed";

/// Makes a body with RVEs of these realisations assigned to its points by the seed; those of a rock to the cells of the group
/// of that name, or of the weak seed. Throws std::invalid_argument where
/// they are not of the dimension that the geometry needs.
template <int dim>
std::unique_ptr<SampleBody> make_body_of_grains(const SampleParameters& sample, const SampleSetUp& set_up,
                                                const EquilibriumParameters& equilibrium,
                                                std::vector<Realisation<dim>> realisations, std::uint64_t seed);
/// A body of the material that sample.material names, without grains.
std::unique_ptr<SampleBody> make_continuous_body(const SampleParameters& sample, const SampleSetUp& set_up,
                                                 const ContinuumParameters& continuum);
} // namespace feldspar

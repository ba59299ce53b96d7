#pragma once

#include "base/voigt.h"

#include <any>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <stdexcept>
#include <string>
#include <vector>

/// The constitutive seam: what the finite elements ask of a material, and all they know of it.
///
/// Small strain, SI, tension positive, in Voigt's order (base/voigt.h).
namespace feldspar::fem
{
template <int dim>
using StrainVector = Voigt<dim>;

template <int dim>
using StressVector = Voigt<dim>; ///< [Pa]

template <int dim>
using StiffnessMatrix = Stiffness<dim>; ///< [Pa]

/// Stress and its derivative by strain.
template <int dim>
struct MaterialResponse
{
  StressVector<dim> stress;
  StiffnessMatrix<dim> tangent;
};

/// The events in a point, and its stress after them [Pa].
template <int dim>
struct PointEvents
{
  std::size_t n;
  StressVector<dim> stress;
};

/// Per cubic metre since the start [J/m³], each summed on its own.
struct PointEnergies
{
  double stored = 0.0;
  double slip = 0.0;     ///< lost by friction and plastic flow
  double released = 0.0; ///< lost by what broke
  double settled = 0.0;  ///< lost on the way to equilibrium after a break
};

/// A crack that opened within a point, in the axes of the material.
template <int dim>
struct PointCrack
{
  bool in_tension;       ///< else in shear
  std::uint32_t segment; ///< its number within the point
  Eigen::Matrix<double, dim, 1> normal;
  double size;             ///< length in the plane, root of the area in space [m]
  double released_energy;  ///< [J]
  double released_density; ///< by it, per volume of the piece of the sample at the point [J/m³]
};

/// A point has no response to the strain asked: the step is cut, not the run ended.
struct PointFailure : std::runtime_error
{
  using std::runtime_error::runtime_error;
};

/// One material point. It keeps two states: the accepted one, which only accept() changes, and the structure at work
/// (bonds, for a grain specimen), which relax() may change and reject() puts back.
///
/// One step asks, in this order and any number of times where … stands:
///
///     trial(strain) …    Newton's method, structure frozen
///     relax(strain)      events at the strain found; none: the step stands, else Newton's method again
///     accept(strain)     or reject()
///
/// Points are worked on by several threads at once, each by one: they share nothing that changes.
template <int dim>
class MaterialPoint
{
public:
  virtual ~MaterialPoint() = default;

  /// The response to a strain from the accepted state, with the structure at work frozen. No history comes from what was
  /// tried before, though a search may begin where the last one ended; a response may be kept for the accept() that
  /// follows. May throw PointFailure.
  virtual MaterialResponse<dim> trial(const StrainVector<dim>& strain) const = 0;

  /// Lets the structure at work change (break) at this strain until it is stable. Returns the number of events.
  /// May throw PointFailure.
  virtual std::size_t relax(const StrainVector<dim>& /*strain*/) { return 0; }

  /// The same up to the first event only, or those that happen at once. May throw PointFailure.
  virtual PointEvents<dim> relax_once(const StrainVector<dim>& strain)
  {
    const std::size_t n = relax(strain);
    return {n, trial(strain).stress};
  }

  /// Makes the response to this strain and the structure at work history. Cannot fail at a strain at which relax() has just
  /// found nothing, so that no point of a sample is left behind by the others; elsewhere it may throw PointFailure, and the
  /// point keeps its state.
  virtual void accept(const StrainVector<dim>& /*strain*/) {}

  /// Puts the structure at work back to the accepted one.
  virtual void reject() {}

  /// The accepted state as bytes that restore() of the same program understands; it puts the structure at work back to
  /// that state too. A point without history has none. restore() may throw where the bytes are damaged.
  virtual std::string stored() const { return {}; }
  virtual void restore(const std::string& /*stored*/) {}

  /// Values of the accepted state for output, in the order of Material::field_names.
  virtual std::vector<double> fields() const { return {}; }

  /// The energies of the structure at work, after its last event or accept(); none where they are not known.
  virtual std::optional<PointEnergies> energies() const { return {}; }

  /// Opened in the last accepted step.
  virtual std::vector<PointCrack<dim>> cracks_of_last_step() const { return {}; }

  /// Something has broken in the accepted state.
  virtual bool is_damaged() const { return false; }

  /// The structure in the accepted state, of a type that the material names; empty where there is none.
  virtual std::any structure() const { return {}; }
};

/// Position of a point in the sample; the same for any number of ranks.
struct PointPlace
{
  std::string cell;              ///< deal.II's CellId, as in 0_3:201
  std::uint64_t cell_number;     ///< among all cells of the sample, from 0
  unsigned int quadrature_point; ///< within the cell, from 0
  std::vector<double> position;  ///< [m], in the coordinates of the sample
  double element_size;           ///< (volume, in the plane and in r-z area, of the cell)^(1/dim) / order [m]
  /// The outward normal of the side of the sample, without its ends, that the cell lies on, in the coordinates of the
  /// sample; empty inside.
  std::vector<double> side_normal = {};
};

/// The material of a sample.
template <int dim>
struct Material
{
  std::function<std::unique_ptr<MaterialPoint<dim>>(const PointPlace&)> make_point;
  std::vector<std::string> field_names; ///< of MaterialPoint::fields(), with unit, as in "dissipation_J_per_m3"
};
} // namespace feldspar::fem
